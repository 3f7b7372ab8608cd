// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "core/errors.hpp"
#include "run/files/line_file.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/run_output.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_line_file {

namespace fs = std::filesystem;
using files::LineFile;
using files::Start;

TEST_CASE("a continued file keeps its whole lines at every length at which a power cut left it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "f.txt";
  const std::string text = "# header\nfirst line\nsecond line\n";
  for (std::size_t length = 0; length <= text.size(); ++length) {
    files::write_text_file(file, text.substr(0, length));
    const std::size_t whole = length == 0 ? 0 : text.rfind('\n', length - 1) + 1;
    LineFile lines(file, "# header\n", Start::kContinue);
    CHECK(lines.removed_bytes() == length - whole);
    lines.add("appended\n");
    lines.flush();
    const std::string kept = whole == 0 ? "# header\n" : text.substr(0, whole);
    CHECK(files::read_text_file(file) == kept + "appended\n");
  }
}

TEST_CASE("zeros at the end of a file, which some file systems leave after a power cut, are removed") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "f.txt";
  files::write_text_file(file, "# header\nline\n" + std::string(9'000, '\0'));
  LineFile lines(file, "# header\n", Start::kContinue);
  lines.add("next\n");
  lines.flush();
  CHECK(files::read_text_file(file) == "# header\nline\nnext\n");
}

TEST_CASE("a file or folder that is deleted in the run is written anew") {
  const TemporaryFolder folder;
  const fs::path inside = folder.path() / "run";
  fs::create_directory(inside);
  LineFile lines(inside / "f.txt", "# header\n", Start::kContinue);
  lines.add("1\n");
  lines.flush();
  fs::remove(inside / "f.txt");
  lines.add("2\n");
  lines.flush();
  CHECK(files::read_text_file(inside / "f.txt") == "# header\n2\n");
  fs::remove_all(inside);
  lines.add("3\n");
  lines.flush();
  CHECK(files::read_text_file(inside / "f.txt") == "# header\n3\n");
}

TEST_CASE("lines that the disk refuses are kept and written later") {
  const TemporaryFolder folder;
  const fs::path inside = folder.path() / "run";
  fs::create_directory(inside);
  LineFile lines(inside / "f.txt", "# header\n", Start::kContinue);
  lines.flush();
  // A file in the place of the folder: nothing can be written there.
  fs::rename(inside, folder.path() / "away");
  files::write_text_file(inside, "");
  lines.add("1\n");
  CHECK_THROWS_AS(lines.flush(), ServiceError);
  lines.add("2\n");
  CHECK_THROWS_AS(lines.flush(), ServiceError);
  fs::remove(inside);
  fs::rename(folder.path() / "away", inside);
  lines.flush();
  CHECK(files::read_text_file(inside / "f.txt") == "# header\n1\n2\n");
  // More than are kept: the oldest stay, the others are counted.
  const std::string line(1'000, 'x');
  for (std::size_t i = 0; i <= LineFile::kMaxPendingBytes / line.size(); ++i) lines.add(line);
  CHECK(lines.dropped_lines() == 1);
}

TEST_CASE("a full disk keeps whole lines") {
  // /dev/full takes nothing; a partial write is tested by tests/integration/continue on a full tmpfs.
  LineFile lines("/dev/full", "", Start::kContinue);
  lines.add("1\n");
  CHECK(message_of([&] { lines.flush(); }) == "/dev/full: cannot be written: No space left on device");
  CHECK(lines.pending_bytes() == 2);
}

TEST_CASE("poses of another map frame go into files of their own") {
  const TemporaryFolder folder;
  files::RunOutput output(folder.path(), Start::kContinue, 1);
  PoseEstimate pose;
  output.add_pose(pose, {});
  pose.session = 2;
  output.add_pose(pose, {});
  output.add_pose(pose, {});
  output.flush();
  const auto lines_in = [&](const char* name) {
    const std::string text = files::read_text_file(folder.path() / name);
    return std::count(text.begin(), text.end(), '\n');
  };
  CHECK(lines_in("trajectory.tum") == 2);
  CHECK(lines_in("trajectory_2.tum") == 3);
  CHECK(lines_in("status_2.csv") == 3);
  CHECK(files::newest_session(folder.path()) == 2);
}

TEST_CASE("a folder of others is refused, and nothing in it is touched") {
  const TemporaryFolder folder;
  const fs::path mine = folder.path() / "home";
  fs::create_directory(mine);
  files::refuse_foreign_folder(mine, "map.toml", "map.directory");  // empty
  files::write_text_file(mine / ".hidden", "");
  files::refuse_foreign_folder(mine, "map.toml", "map.directory");
  files::write_text_file(mine / "00000000.tiles", "thesis");
  CHECK(message_of([&] {
          files::refuse_foreign_folder(mine, "map.toml", "map.directory");
        }).starts_with("map.directory: " + mine.string() + " holds files of others (00000000.tiles)"));
  CHECK_THROWS_AS(files::refuse_foreign_folder(mine, "", "output.directory"), ConfigError);
  files::write_text_file(mine / "trajectory_7.tum", "");
  files::refuse_foreign_folder(mine, "", "output.directory");
  CHECK(files::newest_session(mine) == 7);
  CHECK_THROWS_AS(files::refuse_foreign_folder(mine / ".hidden", "", "output.directory"), ConfigError);
}

TEST_CASE("removing a run leaves the files of others") {
  const TemporaryFolder folder;
  for (const char* name :
       {"trajectory.tum", "trajectory_2.tum", "status.csv", "covariance.csv", "map.ply", "settings.toml",
        "counters.csv", "checkpoint", "mounts.toml", "notes.txt", "trajectory_old.tum"}) {
    files::write_text_file(folder.path() / name, "x");
  }
  CHECK(files::holds_run(folder.path()));
  files::remove_run(folder.path());
  CHECK_FALSE(files::holds_run(folder.path()));
  CHECK(fs::exists(folder.path() / "notes.txt"));
  CHECK(fs::exists(folder.path() / "trajectory_old.tum"));
  CHECK_FALSE(fs::exists(folder.path() / "trajectory_2.tum"));
  CHECK_FALSE(fs::exists(folder.path() / "covariance.csv"));
  CHECK_FALSE(fs::exists(folder.path() / "mounts.toml"));
}

}  // namespace isobar::test::test_line_file

// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config_watch.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_config_watch {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
namespace fs = std::filesystem;

/// A watched folder, and a clock that the test moves.
class Watched {
 public:
  Watched() {
    fs::create_directories(root() / "conf.d");
    write("isobar.toml");
    watch_.emplace(root() / "isobar.toml");
    (void)told();
  }
  [[nodiscard]] fs::path root() const { return folder_.path() / "isobar"; }
  void write(const std::string& file) const { std::ofstream(root() / file) << "x"; }
  /// Whether a change is told within 3 s.
  bool told() {
    bool told = false;
    for (int i = 0; i < 30; ++i) told = watch_->changed(now_ += 100ms) || told;
    return told;
  }
  bool told_at_once() { return watch_->changed(now_ += 100ms); }
  [[nodiscard]] bool works() const { return watch_->works(); }

 private:
  TemporaryFolder folder_;
  std::optional<ConfigWatch> watch_;
  ConfigWatch::Clock::time_point now_ = ConfigWatch::Clock::now();
};

}  // namespace

TEST_CASE("a file is told when it is closed, replaced by rename, deleted, linked or made readable") {
  Watched watched;
  REQUIRE(watched.works());
  CHECK_FALSE(watched.told());
  watched.write("isobar.toml");
  CHECK(watched.told());
  watched.write("conf.d/a.toml");
  CHECK(watched.told());
  watched.write("conf.d/new");
  CHECK_FALSE(watched.told());
  fs::rename(watched.root() / "conf.d/new", watched.root() / "conf.d/b.toml");
  CHECK(watched.told());
  fs::remove(watched.root() / "conf.d/b.toml");
  CHECK(watched.told());
  fs::create_symlink("a.toml", watched.root() / "conf.d/c.toml");
  CHECK(watched.told());
  REQUIRE(mkfifo((watched.root() / "conf.d/pipe.toml").c_str(), 0600) == 0);
  CHECK(watched.told());
  fs::create_directory(watched.root() / "conf.d/folder.toml");
  CHECK(watched.told());
  fs::permissions(watched.root() / "conf.d/a.toml", fs::perms::owner_read);
  CHECK(watched.told());
  watched.write("other.toml");
  watched.write("conf.d/.a.toml.swp");
  CHECK_FALSE(watched.told());
}

TEST_CASE("a file that is being written is not told before it is closed") {
  Watched watched;
  std::ofstream file(watched.root() / "conf.d/a.toml");
  file << "half" << std::flush;
  CHECK_FALSE(watched.told());
  file.close();
  CHECK(watched.told());
}

TEST_CASE("a change is told after a rest, and at the latest after two seconds") {
  Watched watched;
  watched.write("isobar.toml");
  CHECK_FALSE(watched.told_at_once());
  int ticks = 0;
  for (bool told = false; !told && ticks < 100; ++ticks) {
    watched.write("isobar.toml");
    told = watched.told_at_once();
  }
  CHECK(ticks >= 15);
  CHECK(ticks <= 25);
}

TEST_CASE("folders that are replaced, or come later, are watched") {
  Watched watched;
  fs::remove_all(watched.root() / "conf.d");
  CHECK(watched.told());
  fs::create_directory(watched.root() / "conf.d");
  CHECK(watched.told());
  watched.write("conf.d/a.toml");
  CHECK(watched.told());
  fs::rename(watched.root(), watched.root().parent_path() / "old");
  (void)watched.told();
  fs::create_directories(watched.root() / "conf.d");
  watched.write("isobar.toml");
  CHECK(watched.told());
  watched.write("conf.d/b.toml");
  CHECK(watched.told());
}

}  // namespace isobar::test::test_config_watch

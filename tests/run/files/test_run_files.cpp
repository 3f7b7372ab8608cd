// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <string>

#include "core/errors.hpp"
#include "run/files/ply_reader.hpp"
#include "run/files/ply_writer.hpp"
#include "run/files/pose_writer.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_run_files {

using isobar::test::TemporaryFolder;

TEST_CASE("close() writes the number of points into the PLY header, whose length is constant") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "map.ply";
  files::PlyWriter writer(file);
  for (int i = 0; i < 12345; ++i) {
    writer.add(static_cast<float>(i), 2.0F * static_cast<float>(i), -1.0F, 7.0F);
  }
  writer.close();
  const files::PlyPoints all = files::read_ply_points(file, 1'000'000);
  CHECK(all.total == 12345);
  REQUIRE(all.points.size() == 12345);
  CHECK(all.points[12344] == std::array<float, 3>{12344.0F, 24688.0F, -1.0F});
  CHECK(std::filesystem::file_size(file) % 16 == [&] {
    files::PlyWriter empty(folder.path() / "empty.ply");
    empty.close();
    return std::filesystem::file_size(folder.path() / "empty.ply") % 16;
  }());
  const files::PlyPoints thinned = files::read_ply_points(file, 1000);
  CHECK(thinned.total == 12345);
  CHECK(thinned.points.size() <= 1000);
  CHECK(thinned.points.size() > 900);
}

TEST_CASE("a broken PLY file is refused with file, line and rule") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "m.ply";
  const auto message = [&](std::string_view text) {
    files::write_text_file(file, text);
    return message_of([&] { files::read_ply_points(file, 100); });
  };
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  CHECK(message("") == file.string() + ": has no 'end_header'");
  CHECK(message("hello\n") == file.string() + ":1: is not a PLY file");
  CHECK(message(head + "2\n" + xyz + "12 bytes....") ==
        file.string() + ": holds fewer than the 2 vertices of its header");
  CHECK(message(head + "99999999999999\n" + xyz) ==
        file.string() + ": holds fewer than the 99999999999999 vertices of its header");
  CHECK(message(head + "-1\n" + xyz) == file.string() + ":3: '-1' is not a number of elements");
  CHECK(message(head + "0\nproperty list uchar int x\nend_header\n") ==
        file.string() + ":4: a vertex property of type 'list' is not understood");
  CHECK(message(head + "0\nproperty float x\nend_header\n") == file.string() + ": has no x, y, z");
  CHECK(message("ply\nformat ascii 1.0\nelement vertex 0\n" + xyz) ==
        file.string() + ": the format must be binary_little_endian 1.0");
  CHECK(message(head + "1\n" + xyz + "abcdefghijkl") == "no error");
}

TEST_CASE("errors name the file that cannot be read or written") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(files::read_text_file(folder.path() / "none"), DataError);
  CHECK(message_of([&] { files::read_text_file(folder.path()); }) ==
        folder.path().string() + ": is a directory, not a file");
  CHECK_THROWS_AS(files::PoseWriter("/proc/isobar"), ServiceError);
  CHECK_THROWS_AS(files::write_text_file(folder.path() / "none" / "file", "x"), ServiceError);
  CHECK_THROWS_AS(files::write_text_file("/dev/full", "x"), ServiceError);
}

}  // namespace isobar::test::test_run_files

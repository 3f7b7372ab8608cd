// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/errors.hpp"
#include "run/files/replay_output.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_replay_output {

using namespace isobar::files;
using isobar::test::TemporaryFolder;

namespace {

PoseEstimate some_pose(std::uint32_t i) {
  PoseEstimate pose;
  pose.stamp_ns = 1'700'000'000'123'456'789 + 100'000'000LL * i;
  pose.sequence = i;
  pose.mode = PoseMode::kRegistered;
  pose.effective_method = Method::k4DofAltitude;
  pose.T_map_base.translation() = Eigen::Vector3d(0.1 * i, -2.5, 1e-3 * i);
  pose.T_map_base.linear() =
      Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  pose.covariance(2, 2) = 0.0004;
  pose.registration_ms = 12.5;
  return pose;
}

template <typename Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("poses and status rows come back from a replay folder as they were written") {
  const TemporaryFolder folder;
  files::ReplayOutputWriter writer(folder.path() / "new" / "run");
  for (std::uint32_t i = 0; i < 50; ++i) writer.add(some_pose(i), i == 7 ? NAN : 0.25 * i, 0.05);
  CHECK(writer.count() == 50);
  writer.write_settings("a = 1\n");
  writer.close();

  const files::ReplayOutput run = files::read_replay_output(folder.path() / "new" / "run");
  REQUIRE(run.trajectory.poses.size() == 50);
  REQUIRE(run.status.size() == 50);
  for (std::uint32_t i = 0; i < 50; ++i) {
    const PoseEstimate pose = some_pose(i);
    CHECK(run.trajectory.poses[i].stamp_ns == pose.stamp_ns);
    CHECK((run.trajectory.poses[i].position_m - pose.T_map_base.translation()).norm() <
          1e-6);  // six decimals
    CHECK(run.trajectory.poses[i].attitude.angularDistance(Eigen::Quaterniond(pose.T_map_base.linear())) <
          1e-7);
    CHECK(run.status[i].stamp_ns == pose.stamp_ns);
    CHECK(run.status[i].method == "4dof-altitude");
    CHECK(run.status[i].mode == "registered");
    CHECK(run.status[i].scan_ms == doctest::Approx(12.5));
    CHECK(run.status[i].sd_z_m == doctest::Approx(0.02));
    if (i != 7) CHECK(run.status[i].altimeter_height_m == doctest::Approx(0.25 * i));
  }
  CHECK(std::isnan(run.status[7].altimeter_height_m));
  CHECK(run.map_points.empty());
  CHECK(files::read_text_file(folder.path() / "new" / "run" / "settings.toml") == "a = 1\n");
}

TEST_CASE("stamps before 1970 and absurd values still make lines that can be read") {
  const TemporaryFolder folder;
  files::ReplayOutputWriter writer(folder.path());
  PoseEstimate pose = some_pose(1);
  pose.stamp_ns = -1'500'000'000;
  pose.T_map_base.translation().setConstant(1e300);
  pose.residual_rms_m = -1e308;
  pose.overlap = INFINITY;
  writer.add(pose, -NAN, INFINITY);
  writer.close();
  const files::ReplayOutput run = files::read_replay_output(folder.path());
  CHECK(run.trajectory.poses[0].stamp_ns == -1'500'000'000);
  CHECK(run.trajectory.poses[0].position_m.x() == doctest::Approx(1e300));
  CHECK(run.status.size() == 1);
}

TEST_CASE("the number of points stands in the map's header after close(), with a header of fixed length") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "map.ply";
  files::PlyWriter writer(file);
  for (int i = 0; i < 12345; ++i)
    writer.add(static_cast<float>(i), 2.0F * static_cast<float>(i), -1.0F, 7.0F);
  writer.close();
  std::uint64_t total = 0;
  const auto all = files::read_ply_points(file, 1'000'000, total);
  CHECK(total == 12345);
  REQUIRE(all.size() == 12345);
  CHECK(all[12344] == std::array<float, 3>{12344.0F, 24688.0F, -1.0F});
  CHECK(std::filesystem::file_size(file) % 16 == [&] {
    files::PlyWriter empty(folder.path() / "empty.ply");
    empty.close();
    return std::filesystem::file_size(folder.path() / "empty.ply") % 16;
  }());
  const auto thinned = files::read_ply_points(file, 1000, total);
  CHECK(total == 12345);
  CHECK(thinned.size() <= 1000);
  CHECK(thinned.size() > 900);
}

TEST_CASE("a broken map is refused in words") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "m.ply";
  std::uint64_t total = 0;
  const auto message = [&](std::string_view text) {
    files::write_text_file(file, text);
    return message_of([&] { files::read_ply_points(file, 100, total); });
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

TEST_CASE("status.csv needs t_ns only, ignores what it does not know, and names what is broken") {
  const auto rows = files::parse_status_csv("extra,scan_ms,t_ns\n1,,5\n2,3.5,6\n", "s");
  REQUIRE(rows.size() == 2);
  CHECK(std::isnan(rows[0].scan_ms));
  CHECK(rows[1].scan_ms == 3.5);
  CHECK(std::isnan(rows[1].sd_z_m));
  CHECK(message_of([] { files::parse_status_csv("scan_ms\n1\n", "s"); }) ==
        "s:1: the column 't_ns' is missing");
  CHECK(message_of([] { files::parse_status_csv("t_ns,scan_ms\n1,fast\n", "s"); }) ==
        "s:2: scan_ms: 'fast' is not a number");
}

TEST_CASE("files that cannot be read or written are named") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(files::read_text_file(folder.path() / "none"), DataError);
  CHECK(message_of([&] { files::read_text_file(folder.path()); }) ==
        folder.path().string() + ": is a directory, not a file");
  CHECK_THROWS_AS(files::read_replay_output(folder.path()), DataError);
  CHECK_THROWS_AS(files::ReplayOutputWriter("/proc/isobar"), ServiceError);
  CHECK_THROWS_AS(files::write_text_file(folder.path() / "none" / "file", "x"), ServiceError);
  CHECK_THROWS_AS(files::write_text_file("/dev/full", "x"), ServiceError);
}

}  // namespace isobar::test::test_replay_output

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "run/recording/reference.hpp"
#include "tests/run/import/bag_builder.hpp"
#include "tests/run/import/message_builder.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_replay_foreign {
namespace {

constexpr std::int64_t kFirstNs = 1'700'000'000'000'000'000;
/// Way along x between two clouds [m].
constexpr double kStepM = 0.1;

/// What a lidar of 16 rings sees of a room of 12 x 8 x 4 m with a pillar, from `x_m` on its axis.
std::vector<TestPoint> room_from(double x_m, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.01);
  std::vector<TestPoint> points;
  for (int column = 0; column < 360; ++column) {
    for (int ring = 0; ring < 16; ++ring) {
      const double azimuth = column * M_PI / 180.0;
      const double elevation = (2.0 * ring - 15.0) * M_PI / 180.0;
      const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const auto to_wall = [](double at, double direction, double low, double high) {
        if (std::abs(direction) < 1e-9) return 1e9;
        return ((direction > 0.0 ? high : low) - at) / direction;
      };
      double range = std::min(
          {to_wall(x_m, d.x(), -6.0, 6.0), to_wall(0.0, d.y(), -4.0, 4.0), to_wall(0.0, d.z(), -1.0, 3.0)});
      // A pillar of 0.5 m about (3, 2).
      const Eigen::Vector2d c(3.0 - x_m, 2.0);
      const Eigen::Vector2d u = d.head<2>().normalized();
      const double along = u.dot(c);
      const double off2 = c.squaredNorm() - along * along;
      if (along > 0.0 && off2 < 0.25)
        range = std::min(range, (along - std::sqrt(0.25 - off2)) / d.head<2>().norm());
      const Eigen::Vector3d p = d * (range + noise(random));
      points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0.0F,
                        static_cast<std::uint16_t>(ring)});
    }
  }
  return points;
}

}  // namespace

TEST_CASE(
    "a bag that holds clouds alone is replayed to a trajectory and a map, and leaves no recording behind") {
  const TemporaryFolder folder;
  std::mt19937 random(3);
  std::vector<BagMessage> messages;
  constexpr int kClouds = 12;
  for (int i = 0; i < kClouds; ++i) {
    const std::int64_t ns = kFirstNs + i * std::int64_t{100'000'000};
    messages.push_back({0, ns, cloud_message(Form::kRos1, ns, "lidar", room_from(kStepM * i, random))});
  }
  write_bytes(folder.path() / "foreign.bag",
              rosbag1_file({{"/points", "sensor_msgs/PointCloud2"}}, messages, "lz4"));
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"replay", (folder.path() / "foreign.bag").string()});
    return exit_code(tools::add_replay_command, words);
  };
  REQUIRE(run({"--out", (folder.path() / "run").string(), "--keep", (folder.path() / "kept").string()}) == 0);
  CHECK(std::filesystem::exists(folder.path() / "kept" / "recording.toml"));
  CHECK(std::filesystem::file_size(folder.path() / "run" / "map.ply") > 10'000);
  const auto poses = recording::read_tum(folder.path() / "run" / "trajectory.tum");
  REQUIRE(poses.size() == kClouds);
  CHECK(poses.front().stamp_ns == kFirstNs);
  // The scans' noise is 1 cm, of some thousand points.
  const Eigen::Vector3d way = poses.back().T_map_base.translation() - poses.front().T_map_base.translation();
  CHECK((way - Eigen::Vector3d(kStepM * (kClouds - 1), 0.0, 0.0)).norm() < 0.05);
  // Without --out the run goes to the current folder, with the bag's name; it is not replaced unasked.
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  CHECK(run({}) == 0);
  CHECK(run({}) == 64);
  std::filesystem::current_path(before);
  CHECK(std::filesystem::exists(folder.path() / "foreign-run" / "map.ply"));
  // What cannot be: exit code 64, and nothing is written.
  CHECK(run({"--out", (folder.path() / "none").string(), "--lidar", "/other"}) == 64);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "none"));
}

TEST_CASE("an IMU too short for its attitude to begin costs the map nothing") {
  const TemporaryFolder folder;
  std::mt19937 random(3);
  std::vector<BagMessage> messages;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t ns = kFirstNs + i * std::int64_t{100'000'000};
    messages.push_back({0, ns, cloud_message(Form::kRos1, ns, "lidar", room_from(0.0, random))});
    messages.push_back({1, ns, imu_message(Form::kRos1, ns, "lidar", {0, 0, 0, 1}, {0, 0, 0}, {0, 0, 9.81})});
  }
  write_bytes(
      folder.path() / "short.bag",
      rosbag1_file({{"/points", "sensor_msgs/PointCloud2"}, {"/imu", "sensor_msgs/Imu"}}, messages, ""));
  const auto run = folder.path() / "run";
  REQUIRE(exit_code(tools::add_replay_command,
                    {"replay", (folder.path() / "short.bag").string(), "--out", run.string()}) == 0);
  CHECK(std::filesystem::file_size(run / "map.ply") > 5'000);
  CHECK(recording::read_tum(run / "trajectory.tum").size() == 4);
}

}  // namespace isobar::test::test_replay_foreign

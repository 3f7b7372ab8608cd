// SPDX-License-Identifier: BSD-3-Clause
// A Mid-360, whose IMU is in its packets on a second port: the robot has no other.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <random>
#include <vector>

#include "run/recording/recording_writer.hpp"
#include "tests/drivers/livox/packet_builder.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_lidar_imu {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
constexpr double kTiltRad = 0.15;  // of the lidar, and with it of its IMU, about y
constexpr std::uint16_t kDataPort = 56'301;
constexpr std::uint16_t kImuPort = 56'401;

/// 96 points on the walls of a room of 16 x 12 x 3 m, in the frame of the tilted lidar.
std::vector<LivoxPoint> walls(std::mt19937& random) {
  std::uniform_real_distribution<double> azimuth(-std::numbers::pi, std::numbers::pi);
  std::uniform_real_distribution<double> elevation(-0.12, 0.9);
  std::vector<LivoxPoint> points;
  for (int i = 0; i < 96; ++i) {
    const double a = azimuth(random);
    const double e = elevation(random);
    const Eigen::Vector3d direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    const Eigen::AngleAxisd R_room_lidar(kTiltRad, Eigen::Vector3d::UnitY());
    const Eigen::Vector3d in_room = R_room_lidar * direction;
    const Eigen::Vector3d wall(8.0, 6.0, in_room.z() > 0.0 ? 2.0 : 1.0);
    const double range_m = (wall.array() / in_room.array().abs()).minCoeff();
    const Eigen::Vector3d p_mm = 1e3 * range_m * direction;
    points.push_back({static_cast<int>(std::lround(p_mm.x())), static_cast<int>(std::lround(p_mm.y())),
                      static_cast<int>(std::lround(p_mm.z())), 50, 0});
  }
  return points;
}

std::filesystem::path make_recording(double seconds) {
  const auto folder = fresh_folder("mid360");
  std::filesystem::remove_all(folder);
  recording::Manifest manifest;
  manifest.lidar = recording::LidarEntry{};
  manifest.lidar->model = "Mid-360";
  manifest.lidar->port = kDataPort;
  manifest.lidar->info_port = kImuPort;
  recording::RecordingWriter writer(folder, manifest);
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.002F);
  LivoxPacket packet;
  std::uint64_t imu_ns = 0;
  constexpr std::uint64_t kPacketNs = 480'000;  // 96 points at 200 kHz
  constexpr std::uint64_t kImuNs = 5'000'000;
  for (std::uint64_t now_ns = 0; now_ns < static_cast<std::uint64_t>(seconds * 1e9); now_ns += kPacketNs) {
    packet.timestamp_ns = now_ns;
    const auto stamp_ns = kStartNs + static_cast<std::int64_t>(now_ns + kPacketNs + 100'000);
    writer.add_packet(stamp_ns, packet.points(walls(random)), kDataPort);
    ++packet.udp_cnt;
    for (; imu_ns <= now_ns; imu_ns += kImuNs) {
      LivoxPacket imu;
      imu.timestamp_ns = imu_ns;
      // Specific force in g: up, seen from the tilted lidar.
      const auto up = std::array{static_cast<float>(-std::sin(kTiltRad)) + noise(random), noise(random),
                                 static_cast<float>(std::cos(kTiltRad)) + noise(random)};
      writer.add_packet(kStartNs + static_cast<std::int64_t>(imu_ns) + 400'000,
                        imu.imu({noise(random), noise(random), noise(random)}, up), kImuPort);
    }
  }
  writer.close();
  return folder;
}

}  // namespace

TEST_CASE(
    "the IMU within a lidar gives gravity: a tilted lidar's map is level, with the IMU's samples counted") {
  const auto recording = make_recording(6.0);
  std::filesystem::path out;
  const ReplaySummary summary = run(recording, out, Method::kAdaptive);
  CHECK(summary.scans >= 55);
  CHECK(summary.registered >= 20);
  // 200 a second; none before the first data packet.
  CHECK(count_of(summary, "imu samples") >= 1'150);
  // The last pose: pitch of the robot, to whose base_link the lidar is parallel.
  const std::string poses = bytes_of(out / "trajectory.tum");
  const std::string last = poses.substr(poses.rfind('\n', poses.size() - 2) + 1);
  double t = 0.0;
  double p[3];  // NOLINT(modernize-avoid-c-arrays)
  double q[4];  // NOLINT(modernize-avoid-c-arrays)
  REQUIRE(std::sscanf(last.c_str(), "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &p[0], &p[1], &p[2], &q[0], &q[1],
                      &q[2], &q[3]) == 8);
  CAPTURE(last);
  // Noise of 2 mg in the mean of hundreds of samples is a tenth of a degree at most.
  CHECK(2.0 * std::asin(q[1]) == doctest::Approx(kTiltRad).epsilon(0.02));
}

TEST_CASE("without its second port a lidar's IMU is none") {
  const auto folder = make_recording(3.0);
  std::string text = bytes_of(folder / "recording.toml");
  text.erase(text.find("info_port"), std::string("info_port = 56401\n").size());
  std::ofstream(folder / "recording.toml") << text;
  std::filesystem::path out;
  const ReplaySummary summary = run(folder, out, Method::kAdaptive);
  CHECK(std::any_of(summary.warnings.begin(), summary.warnings.end(),
                    [](const std::string& warning) { return warning.starts_with("no IMU"); }));
}

}  // namespace isobar::test::test_lidar_imu

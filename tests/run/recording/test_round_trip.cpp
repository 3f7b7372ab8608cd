// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/recording_writer.hpp"
#include "run/recording/reference.hpp"
#include "run/text/segments.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_round_trip {

using namespace isobar::recording;

namespace {

using test::Scratch;

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

Manifest full_manifest() {
  Manifest manifest = Manifest::with_all_sensors();
  manifest.description = "three \"floors\",\n311 m \\ é";
  manifest.lidar->port = 2'369;
  manifest.lidar->info_port = 8'309;
  manifest.lidar->mount = {{0.1, 0.0, 0.45}, {1.0, -2.0, 90.0}};
  manifest.imu->mount = {{0.0, 1.0 / 3.0, 0.2}, {0.0, 180.0, 0.0}};
  manifest.barometer->mount.xyz_m = {-0.1, 0.05, 0.3};
  return manifest;
}

}  // namespace

TEST_CASE("A written recording reads back bit for bit, merged in order of time") {
  Scratch scratch;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise;
  RecordingWriter writer(scratch.path(), full_manifest());
  std::vector<ImuSample> imu;
  std::vector<PressureSample> pressure;
  std::vector<PressureSample> base;
  std::vector<WheelSample> wheel;
  std::vector<std::vector<std::uint8_t>> packets;
  for (int i = 0; i < 1'000; ++i) {
    ImuSample sample;
    sample.stamp_ns = kStart + i * std::int64_t{10'000'000} + 3;
    sample.gyro_rad_s = Eigen::Vector3d(noise(random), noise(random) * 1e-7, -noise(random));
    sample.accel_m_s2 = Eigen::Vector3d(noise(random), noise(random), 9.8 + noise(random));
    sample.q_world_imu = Eigen::Quaterniond(noise(random), noise(random), noise(random), noise(random));
    sample.q_world_imu.normalize();
    sample.has_attitude = true;
    imu.push_back(sample);
    writer.add_imu(sample);
    if (i % 10 == 0) {
      pressure.push_back(
          {kStart + i * std::int64_t{10'000'000} + 1, 100'000 + noise(random), 20 + noise(random)});
      base.push_back(
          {kStart + i * std::int64_t{10'000'000} + 2, 100'100 + noise(random), 21 + noise(random)});
      wheel.push_back(
          {kStart + i * std::int64_t{10'000'000} + 4, noise(random), noise(random) * 1e-3, noise(random)});
      writer.add_pressure(pressure.back());
      writer.add_base_pressure(base.back());
      writer.add_wheel(wheel.back());
      std::vector<std::uint8_t> payload(random() % 1'500);
      std::generate(payload.begin(), payload.end(), [&] { return static_cast<std::uint8_t>(random()); });
      packets.push_back(payload);
      writer.add_packet(kStart + i * std::int64_t{10'000'000} + 5, payload);
      writer.add_packet(kStart + i * std::int64_t{10'000'000} + 6, payload,
                        8'308);  // a position packet: for another port
    }
  }
  writer.close();

  RecordingReader reader(scratch.path());
  CHECK(reader.warnings().empty());
  CHECK(reader.manifest().description == full_manifest().description);
  CHECK(reader.manifest().lidar->port == 2'369);
  CHECK(reader.manifest().lidar->info_port == 8'309);
  CHECK(reader.manifest().lidar->mount.rpy_deg == full_manifest().lidar->mount.rpy_deg);
  CHECK(reader.manifest().imu->mount.xyz_m == full_manifest().imu->mount.xyz_m);
  CHECK(reader.base_clock().offset_ns == 0);
  std::size_t read[5] = {};
  std::int64_t last_ns = 0;
  Event event;
  while (reader.next(event)) {
    REQUIRE(event.stamp_ns > last_ns);
    last_ns = event.stamp_ns;
    const std::size_t i = read[static_cast<int>(event.kind)]++;
    switch (event.kind) {
      case EventKind::kImu:
        REQUIRE(event.imu.stamp_ns == imu.at(i).stamp_ns);
        REQUIRE(event.imu.gyro_rad_s == imu[i].gyro_rad_s);
        REQUIRE(event.imu.accel_m_s2 == imu[i].accel_m_s2);
        REQUIRE(event.imu.q_world_imu.coeffs() == imu[i].q_world_imu.coeffs());
        REQUIRE(event.imu.has_attitude);
        break;
      case EventKind::kPressure:
        REQUIRE(event.pressure.pressure_pa == pressure.at(i).pressure_pa);
        REQUIRE(event.pressure.temperature_c == pressure[i].temperature_c);
        break;
      case EventKind::kBasePressure:
        REQUIRE(event.pressure.pressure_pa == base.at(i).pressure_pa);
        break;
      case EventKind::kWheel:
        REQUIRE(event.wheel.vx_m_s == wheel.at(i).vx_m_s);
        REQUIRE(event.wheel.vy_m_s == wheel[i].vy_m_s);
        REQUIRE(event.wheel.wz_rad_s == wheel[i].wz_rad_s);
        break;
      case EventKind::kCloud:
        break;
      case EventKind::kLidarPacket:
        REQUIRE(std::vector<std::uint8_t>(event.packet.begin(), event.packet.end()) == packets.at(i));
        break;
    }
  }
  CHECK(read[static_cast<int>(EventKind::kImu)] == imu.size());
  CHECK(read[static_cast<int>(EventKind::kPressure)] == pressure.size());
  CHECK(read[static_cast<int>(EventKind::kBasePressure)] == base.size());
  CHECK(read[static_cast<int>(EventKind::kWheel)] == wheel.size());
  CHECK(read[static_cast<int>(EventKind::kLidarPacket)] == packets.size());
  CHECK(test::count_of(reader, "lidar: frames for another port") == 100);
  CHECK(reader.progress() == 1.0);
}

TEST_CASE("A packet longer than a frame of Ethernet is captured in fragments, and read back whole") {
  Scratch scratch;
  Manifest manifest;
  manifest.lidar.emplace();
  // One frame; fragments with a last one of a few bytes; an Ouster's; the longest.
  std::vector<std::vector<std::uint8_t>> packets;
  for (const std::size_t size : {1'472U, 1'473U, 2'952U, 2'953U, 6'464U, 65'507U}) {
    packets.emplace_back(size);
    for (std::size_t i = 0; i < size; ++i) packets.back()[i] = static_cast<std::uint8_t>(i * 7 + size);
  }
  RecordingWriter writer(scratch.path(), manifest);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    writer.add_packet(kStart + static_cast<std::int64_t>(i) * 1'000'000, packets[i]);
  }
  writer.close();
  std::ifstream file(scratch.path() / "lidar.pcap", std::ios::binary);
  const std::string capture((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::size_t frames = 0;
  for (std::size_t at = 24; at < capture.size(); ++frames) {  // headers of file and frames: 24 and 16 bytes
    std::uint32_t size = 0;
    std::memcpy(&size, capture.data() + at + 8, sizeof size);
    CHECK(size <= 1'514);
    at += 16 + size;
  }
  CHECK(frames == 1 + 2 + 2 + 3 + 5 + 45);
  RecordingReader reader(scratch.path());
  Event event;
  for (const auto& packet : packets) {
    REQUIRE(reader.next(event));
    CHECK(std::equal(packet.begin(), packet.end(), event.packet.begin(), event.packet.end()));
  }
  CHECK_FALSE(reader.next(event));
}

TEST_CASE(
    "The variances of wheels survive where their sender states them; else the file has no such columns") {
  for (const bool are_stated : {false, true}) {
    Scratch scratch;
    Manifest manifest;
    manifest.wheel = SensorEntry{"wheel.csv", {}};
    RecordingWriter writer(scratch.path(), manifest);
    WheelSample sample{kStart, 0.5, 0.0, 0.25};
    if (are_stated) sample.vx_variance_m2_s2 = 1.0 / 3.0;
    if (are_stated) sample.wz_variance_rad2_s2 = 0.01;
    writer.add_wheel(sample);
    writer.close();

    std::ifstream file(scratch.path() / "wheel.csv");
    std::string header;
    std::getline(file, header);
    CHECK((header == "t_ns,vx_m_s,vy_m_s,wz_rad_s") == !are_stated);
    RecordingReader reader(scratch.path());
    Event event;
    REQUIRE(reader.next(event));
    CHECK(event.wheel.wz_rad_s == 0.25);
    CHECK(std::isnan(event.wheel.vy_variance_m2_s2));
    if (are_stated) {
      CHECK(event.wheel.vx_variance_m2_s2 == 1.0 / 3.0);
      CHECK(event.wheel.wz_variance_rad2_s2 == 0.01);
    } else {
      CHECK(std::isnan(event.wheel.vx_variance_m2_s2));
      CHECK(std::isnan(event.wheel.wz_variance_rad2_s2));
    }
  }
}

TEST_CASE("Trajectories and segments survive writing and reading") {
  Scratch scratch;
  Manifest manifest;
  manifest.reference = SensorEntry{"reference.tum", {}};
  RecordingWriter writer(scratch.path(), manifest);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1.0 / 3.0, -2e-9, 12345.678);
  pose.rotate(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized()));
  writer.add_reference(kStart + 7, pose);
  writer.add_segment({kStart, kStart + 10, "stairs"});
  writer.close();
  const auto poses = read_tum(scratch.path() / "reference.tum");
  REQUIRE(poses.size() == 1);
  CHECK(poses[0].stamp_ns == kStart + 7);
  CHECK(poses[0].T_map_base.translation() == pose.translation());
  CHECK((poses[0].T_map_base.linear() - pose.linear()).norm() < 1e-14);  // through a quaternion and back
  const auto segments = text::read_segments(text::TextLines(scratch.path() / "segments.csv"));
  REQUIRE(segments.size() == 1);
  CHECK(segments[0].start_ns == kStart);
  CHECK(segments[0].end_ns == kStart + 10);
  CHECK(segments[0].label == "stairs");
}

TEST_CASE("A recording never overwrites another one") {
  Scratch scratch;
  RecordingWriter(scratch.path(), Manifest{}).close();
  CHECK_THROWS_AS(RecordingWriter(scratch.path(), Manifest{}), DataError);
}

TEST_CASE("The error of a broken trajectory names row and rule") {
  Scratch scratch;
  for (const char* row : {"1.0 0 0 0 0 0 0", "1.0 0 0 0 0 0 0 1 5", "x 0 0 0 0 0 0 1", "1 nan 0 0 0 0 0 1",
                          "1 0 0 0 0 0 0 0"}) {
    scratch.write("a.tum", std::string("# c\n1.000000001 0 0 0 0 0 0 1\n") + row + "\n");
    CHECK_THROWS_WITH_AS(read_tum(scratch.path() / "a.tum"), doctest::Contains("a.tum:3: "), DataError);
  }
}

}  // namespace isobar::test::test_round_trip

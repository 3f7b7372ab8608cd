// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/drivers/ouster/ouster_sensor.hpp"

namespace isobar::test::test_ouster_decoder {

TEST_CASE("Every profile gives the returns that were encoded, by row, column and time") {
  for (const char* profile : {"LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
                              "RNG15_RFL8_NIR8", "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"}) {
    CAPTURE(profile);
    OusterPlan plan;
    plan.profile = profile;
    plan.first_id = 160;
    const bool dual = plan.profile.ends_with("DUAL");
    const auto decoder = decoder_for(plan);
    const auto points = decode_packet(*decoder, build_ouster_packet(plan));
    REQUIRE(points.size() == 16U * 32U * (dual ? 2U : 1U));
    std::size_t at = 0;
    for (int column = 0; column < 16; ++column) {
      for (int row = 0; row < 32; ++row) {
        for (int number = 0; number < (dual ? 2 : 1); ++number) {
          const ScanPoint& point = points[at++];
          const OusterReturn target = plan.target(160 + column, row, number);
          CHECK(int{point.ring} == 31 - row);
          CHECK(int{point.intensity} == static_cast<int>(target.reflectivity));
          // 97.656 us a column; 4 us resolution.
          CHECK(point.time_4us * 4.0 == doctest::Approx(column * 97.656).epsilon(0.03).scale(100.0));
          // From the lidar's origin, 36.18 mm up: 15.806 mm to the beam's origin and then along the beam. The
          // distance in the plane of rotation differs from the straight sum by the beam's azimuth of 4.2 deg.
          const double height_m = point.z_m - 0.03618;
          const double altitude = (22.5 - 45.0 * row / 31.0) * 3.14159265358979 / 180.0;
          CHECK(height_m ==
                doctest::Approx((target.range_mm * 1e-3 - 0.015806) * std::sin(altitude)).epsilon(1e-5));
        }
      }
    }
  }
}

TEST_CASE("Missing and equal second returns are dropped; a second return without a first one is kept") {
  OusterPlan plan;
  plan.profile = "RNG19_RFL8_SIG16_NIR16_DUAL";
  plan.target = [](int, int row, int number) {
    if (row == 0) return OusterReturn{number == 0 ? 5'000U : 0U, 10};
    if (row == 1) return OusterReturn{5'000, 20};
    if (row == 2) return OusterReturn{number == 0 ? 0U : 5'000U, 30};
    if (row == 3) return OusterReturn{number == 0 ? 5'000U : 7'000U, 40};
    return OusterReturn{0, 50};
  };
  const auto decoder = decoder_for(plan);
  const auto points = decode_packet(*decoder, build_ouster_packet(plan));
  REQUIRE(points.size() == 16U * 5U);
  const std::array<int, 5> intensities{10, 20, 30, 40, 40};
  for (std::size_t i = 0; i < points.size(); ++i) CHECK(int{points[i].intensity} == intensities[i % 5]);
}

TEST_CASE("A reflectivity of 16 bits above 255 becomes 255") {
  OusterPlan plan;
  plan.profile = "LEGACY";
  plan.target = [](int, int row, int) { return OusterReturn{4'000, row == 0 ? 1'000U : 200U}; };
  const auto decoder = decoder_for(plan);
  const auto points = decode_packet(*decoder, build_ouster_packet(plan));
  CHECK(int{points[0].intensity} == 255);
  CHECK(int{points[1].intensity} == 200);
}

TEST_CASE("The mask takes the sector by the direction in the sensor's frame, ahead being azimuth 0") {
  OusterPlan plan;
  LidarLimits limits;
  limits.mask_start_deg = 350.0;
  limits.mask_end_deg = 10.0;
  const auto decoder = decoder_for(plan, limits);
  std::size_t points = 0;
  for (int id = 0; id < 1'024; id += 16) {
    plan.first_id = id;
    plan.first_ns += 1'562'500;
    for (const ScanPoint& point : decode_packet(*decoder, build_ouster_packet(plan))) {
      const double azimuth_deg = -std::atan2(point.y_m, point.x_m) * 180.0 / 3.14159265358979;
      // Parallax of the beams' origin, 16 mm beside a point 4 m away at 4.2 deg: 0.02 deg.
      CHECK(std::abs(azimuth_deg) > 9.9);
      ++points;
    }
  }
  CHECK(static_cast<double>(points) == doctest::Approx(1'024.0 * 32 * 340 / 360).epsilon(0.005));
}

TEST_CASE("Ranges outside the limits are dropped, to the count") {
  for (const char* profile : {"RNG19_RFL8_SIG16_NIR16", "RNG15_RFL8_NIR8"}) {
    CAPTURE(profile);
    OusterPlan plan;
    plan.profile = profile;
    plan.target = [](int, int row, int) {
      return OusterReturn{static_cast<std::uint32_t>(8 * (row + 100)), 1};
    };
    LidarLimits limits;
    limits.min_range_m = 0.816;  // row 2
    limits.max_range_m = 0.840;  // row 5
    const auto decoder = decoder_for(plan, limits);
    CHECK(decode_packet(*decoder, build_ouster_packet(plan)).size() == 16U * 4U);
  }
}

TEST_CASE("Columns without data give no points, and a packet of them no scan") {
  OusterPlan plan;
  plan.is_valid = [](int id) { return id % 16 >= 4 && id % 16 != 9; };
  const auto decoder = decoder_for(plan);
  const auto bytes = build_ouster_packet(plan);
  PacketColumns columns;
  REQUIRE(decoder->read(bytes, columns) == DecodeStatus::kOk);
  CHECK(columns.count == 11);
  CHECK(columns.turn[0] == 4 * 36'000 / 1'024);
  CHECK(columns.turn[5] == 10 * 36'000 / 1'024);
  std::vector<ScanPoint> points(11 * 32);
  CHECK(decoder->decode(bytes, columns, 5, 11, 0, points.data()) == 6 * 32);
  CHECK(int{points[0].intensity} == 10);
  plan.is_valid = [](int) { return false; };
  CHECK(decoder->read(build_ouster_packet(plan), columns) == DecodeStatus::kNoPoints);
}

TEST_CASE("A turn is a scan; one of 128 beams is divided into scans that are full, and no point is lost") {
  for (const int rows : {32, 128}) {
    CAPTURE(rows);
    OusterPlan plan;
    plan.rows = rows;
    OusterSensor sensor(plan);
    sensor.run(4 * 1'024);
    sensor.assembler->flush(*sensor.open);
    sensor.turn_over();
    CHECK(sensor.assembler->counters().lost == 0);
    CHECK(sensor.assembler->counters().packets == 256);
    std::uint64_t points = 0;
    for (const auto& scan : sensor.scans) points += scan->point_count;
    CHECK(points == std::uint64_t{4} * 1'024 * static_cast<unsigned>(rows));
    CHECK(sensor.scans.size() == (rows == 32 ? 4U : 8U));
  }
}

TEST_CASE("An azimuth window is no loss") {
  OusterPlan plan;
  plan.is_valid = [](int id) { return id >= 200 && id < 700; };
  OusterSensor sensor(plan);
  sensor.run(10 * 1'024);
  CHECK(sensor.assembler->counters().lost == 0);
  REQUIRE(sensor.scans.size() >= 8);
  CHECK(sensor.scans.back()->point_count == 500 * 32);
}

TEST_CASE("IMU packets give samples in m/s2 and rad/s on the robot's clock, in the sensor's axes") {
  OusterPlan plan;
  OusterSensor sensor(plan);
  ImuSample sample;
  CHECK(sensor.send(build_ouster_packet(plan)) == DecodeStatus::kOk);
  CHECK(!sensor.assembler->take_imu(sample));
  CHECK(sensor.send(build_ouster_imu(plan.first_ns + 400'000, {0.5F, 0.25F, 1.0F}, {90.0F, 0.0F, -45.0F})) ==
        DecodeStatus::kNoPoints);
  REQUIRE(sensor.assembler->take_imu(sample));
  CHECK(!sensor.assembler->take_imu(sample));
  CHECK((sample.accel_m_s2 - Eigen::Vector3d(0.5, 0.25, 1.0) * 9.80665).norm() < 1e-12);
  CHECK((sample.gyro_rad_s - Eigen::Vector3d(1.5707963, 0.0, -0.7853982)).norm() < 1e-7);
  // The packet of the lidar was received at the host's time of its first column.
  CHECK(sample.stamp_ns - kOusterHostNs == static_cast<std::int64_t>(plan.first_ns) + 400'000);
  CHECK(sensor.send(build_ouster_imu(5, {std::nanf(""), 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F})) ==
        DecodeStatus::kNoPoints);
  CHECK(!sensor.assembler->take_imu(sample));
}

TEST_CASE("IMU packets of several samples give those that hold data") {
  OusterPlan plan;
  ouster::Metadata metadata = ouster::parse_metadata(build_ouster_metadata(plan, true), "os.json", "OS1");
  metadata.imu_profile = ouster::ImuProfile::kAccel32Gyro32Nmea;
  metadata.R_sensor_imu << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  ouster::Decoder decoder("OS1", metadata);
  PacketColumns columns;
  CHECK(decoder.read(build_ouster_imu_block(9'000, 8, {1.0F, 2.0F, 9.5F}, {0.1F, 0.0F, 0.2F}, 3), columns) ==
        DecodeStatus::kNoPoints);
  std::vector<ImuSample> samples;
  for (ImuSample sample; decoder.take_imu(sample);) samples.push_back(sample);
  REQUIRE(samples.size() == 7);
  CHECK(samples[0].stamp_ns == 9'000);
  CHECK(samples[3].stamp_ns == 9'000 + 4 * 1'562'500);
  CHECK((samples[6].accel_m_s2 - Eigen::Vector3d(-2.0, 1.0, 9.5)).norm() < 1e-6);
  CHECK((samples[6].gyro_rad_s - Eigen::Vector3d(0.0, 0.1, 0.2)).norm() < 1e-6);
}

TEST_CASE("With PTP the clock is locked once it counts from 1970") {
  OusterPlan plan;
  const auto decoder = decoder_for(plan);
  CHECK(decoder->sync() == LidarSync::kUnknown);
  decode_packet(*decoder, build_ouster_packet(plan));
  CHECK(decoder->sync() == LidarSync::kLocking);
  plan.first_ns = 1'700'000'000'000'000'000;
  decode_packet(*decoder, build_ouster_packet(plan));
  CHECK(decoder->sync() == LidarSync::kLocked);
}

}  // namespace isobar::test::test_ouster_decoder

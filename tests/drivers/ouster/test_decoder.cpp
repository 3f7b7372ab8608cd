// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/ouster/decoder.hpp"
#include "tests/drivers/ouster/packet_builder.hpp"

namespace isobar::test::test_ouster_decoder {
namespace {

constexpr std::int64_t kHostNs = 1'700'000'000'000'000'000;

std::unique_ptr<ouster::Decoder> decoder_for(const OusterPlan& plan, const LidarLimits& limits = {},
                                             bool nested = true) {
  return std::make_unique<ouster::Decoder>(
      "OS1", ouster::parse_metadata(build_ouster_metadata(plan, nested), "os.json", "OS1"), limits);
}

/// A sensor that sends turn after turn.
struct Sensor {
  OusterPlan plan;
  std::unique_ptr<ScanAssembler> assembler;
  std::vector<std::unique_ptr<Scan>> scans;
  std::unique_ptr<Scan> open = std::make_unique<Scan>();

  explicit Sensor(const OusterPlan& packets, const OusterPlan& metadata)
      : plan(packets), assembler(std::make_unique<ScanAssembler>(decoder_for(metadata))) {}
  explicit Sensor(const OusterPlan& packets) : Sensor(packets, packets) {}

  DecodeStatus send(const std::vector<std::uint8_t>& bytes) {
    const auto host_ns = kHostNs + static_cast<std::int64_t>(plan.first_ns);
    const DecodeResult result = assembler->add_packet(bytes, host_ns, *open);
    if (result.scan_complete) turn_over();
    return result.status;
  }
  void turn_over() {
    scans.push_back(std::move(open));
    open = std::make_unique<Scan>();
  }
  /// Packets of so many columns; those without a valid column are not sent.
  void run(int columns) {
    const double column_ns = 1e9 / (plan.columns_per_turn * plan.hz);
    const std::uint64_t start_ns = plan.first_ns;
    for (int column = 0; column < columns; column += plan.columns_per_packet) {
      plan.first_id = column % plan.columns_per_turn;
      plan.first_ns = start_ns + static_cast<std::uint64_t>(std::llround(column * column_ns));
      bool any = false;
      for (int i = 0; i < plan.columns_per_packet; ++i) any = any || plan.is_valid(plan.first_id + i);
      if (any) send(build_ouster_packet(plan));
    }
    plan.first_ns = start_ns + static_cast<std::uint64_t>(std::llround(columns * column_ns));
  }
};

std::vector<ScanPoint> decode_packet(ouster::Decoder& decoder, const std::vector<std::uint8_t>& bytes) {
  PacketColumns columns;
  REQUIRE(decoder.read(bytes, columns) == DecodeStatus::kOk);
  std::vector<ScanPoint> points(static_cast<std::size_t>(columns.count) * decoder.points_per_column());
  points.resize(decoder.decode(bytes, columns, 0, columns.count, 0, points.data()));
  return points;
}

}  // namespace

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
    Sensor sensor(plan);
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
  Sensor sensor(plan);
  sensor.run(10 * 1'024);
  CHECK(sensor.assembler->counters().lost == 0);
  REQUIRE(sensor.scans.size() >= 8);
  CHECK(sensor.scans.back()->point_count == 500 * 32);
}

TEST_CASE("Packets that the metadata does not fit are refused, and what they are is said") {
  const OusterPlan plan;
  PacketColumns columns;
  const auto refused = [&](const OusterPlan& other, const std::string& text) {
    const auto decoder = decoder_for(plan);
    CHECK(decoder->read(build_ouster_packet(other), columns) == DecodeStatus::kWrongModel);
    CHECK(decoder->mismatch() == text);
    CHECK(!decoder->is_data(build_ouster_packet(other)));
    CHECK(decoder->is_data(build_ouster_packet(plan)));
  };
  OusterPlan other = plan;
  other.profile = "RNG19_RFL8_SIG16_NIR16_DUAL";
  refused(
      other,
      "packets of 8448 bytes, but os.json says 6400 (32 beams, RNG19_RFL8_SIG16_NIR16); theirs: 32 beams in "
      "RNG19_RFL8_SIG16_NIR16_DUAL, or 64 beams in RNG15_RFL8_NIR8_DUAL/FUSA_RNG15_RFL8_NIR8_DUAL/"
      "RNG15_RFL8_NIR8_ZONE16, or 128 beams in RNG15_RFL8_NIR8/RNG15_RFL8_WIN8");
  other = plan;
  other.serial = 122'000'000'002;
  refused(other,
          "packets of the sensor with serial number 122000000002, but os.json is of 122000000001 (OS-1-32)");
  OusterPlan restarted = plan;
  restarted.init_id = 0x654321;
  CHECK(decoder_for(plan)->read(build_ouster_packet(restarted), columns) == DecodeStatus::kOk);
}

TEST_CASE("Without a serial number in the metadata the initialisation id must be the same") {
  OusterPlan plan;
  OusterPlan metadata = plan;
  metadata.serial = 0;
  PacketColumns columns;
  CHECK(decoder_for(metadata)->read(build_ouster_packet(plan), columns) == DecodeStatus::kOk);
  plan.init_id = 99;
  const auto decoder = decoder_for(metadata);
  CHECK(decoder->read(build_ouster_packet(plan), columns) == DecodeStatus::kWrongModel);
  CHECK(decoder->mismatch() ==
        "packets with initialisation id 99, but os.json has 1193046 and no serial number: read it again");
}

TEST_CASE("Another lidar_mode than the metadata's is found within a turn, whichever has more columns") {
  for (const int sent : {512, 2'048}) {
    for (const double hz : {10.0, 20.0}) {
      CAPTURE(sent);
      CAPTURE(hz);
      OusterPlan plan;
      plan.columns_per_turn = sent;
      plan.hz = hz;
      Sensor sensor(plan, OusterPlan{});
      sensor.run(6 * sent);
      const LidarCounters& counters = sensor.assembler->counters();
      CHECK(counters.packets <= static_cast<unsigned>(std::min(sent, 1'024) / 16));
      CHECK(counters.wrong_model + counters.packets == static_cast<unsigned>(6 * sent / 16));
      CHECK(sensor.assembler->decoder().mismatch() ==
            "packets of " + std::to_string(sent) +
                " columns a turn or more, but os.json says 1024 (lidar_mode)");
    }
  }
}

TEST_CASE("Lost, repeated and reordered packets are no other lidar_mode") {
  OusterPlan plan;
  Sensor sensor(plan);
  std::vector<std::vector<std::uint8_t>> packets;
  for (int column = 0; column < 4 * 1'024; column += 16) {
    plan.first_id = column % 1'024;
    plan.first_ns = 1'000'000'000 + static_cast<std::uint64_t>(std::llround(column * 97'656.25));
    packets.push_back(build_ouster_packet(plan));
  }
  std::swap(packets[70], packets[71]);
  std::swap(packets[127], packets[128]);
  packets.erase(packets.begin() + 180, packets.begin() + 200);
  packets.insert(packets.begin() + 30, packets[29]);
  for (const auto& packet : packets) {
    sensor.plan.first_ns += 1'562'500;
    sensor.send(packet);
  }
  const LidarCounters& counters = sensor.assembler->counters();
  CHECK(counters.wrong_model == 0);
  CHECK(counters.duplicated == 1);
  CHECK(counters.packets == 256 - 20);
  CHECK(counters.lost == 20);
}

TEST_CASE("Impossible fields are garbage; short and long packets are counted") {
  const OusterPlan plan;
  const auto good = build_ouster_packet(plan);
  const auto decoder = decoder_for(plan);
  PacketColumns columns;
  const auto status_with = [&](std::size_t at, std::uint8_t value) {
    auto bytes = good;
    bytes[at] = value;
    return decoder->read(bytes, columns);
  };
  CHECK(status_with(0, 9) == DecodeStatus::kGarbage);             // packet type
  CHECK(status_with(32 + 7, 0xFF) == DecodeStatus::kGarbage);     // timestamp of 2^63 ns
  CHECK(status_with(32 + 3, 0xFF) == DecodeStatus::kGarbage);     // first column after the second
  CHECK(status_with(32 + 9, 0x80) == DecodeStatus::kGarbage);     // measurement id
  CHECK(status_with(32 + 396 + 8, 0) == DecodeStatus::kGarbage);  // the same id twice
  auto bytes = good;
  bytes.pop_back();
  CHECK(decoder->read(bytes, columns) == DecodeStatus::kTruncated);
  bytes.resize(good.size() + 1);
  CHECK(decoder->read(bytes, columns) == DecodeStatus::kOversized);
  CHECK(decoder->read({}, columns) == DecodeStatus::kTruncated);
  CHECK(decoder->read(good, columns) == DecodeStatus::kOk);
}

TEST_CASE("IMU packets give samples in m/s2 and rad/s on the robot's clock, in the sensor's axes") {
  OusterPlan plan;
  Sensor sensor(plan);
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
  CHECK(sample.stamp_ns - kHostNs == static_cast<std::int64_t>(plan.first_ns) + 400'000);
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

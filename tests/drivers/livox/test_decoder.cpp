// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/livox/decoder.hpp"
#include "tests/drivers/livox/packet_builder.hpp"

namespace isobar::test::test_livox_decoder {
namespace {

constexpr std::int64_t kHostNs = 1'700'000'000'000'000'000;

/// 96 points on a circle of a radius.
std::vector<LivoxPoint> circle(int radius_mm) {
  std::vector<LivoxPoint> points;
  for (int i = 0; i < 96; ++i) {
    const double angle = i * 2.0 * 3.14159265358979 / 96;
    points.push_back({static_cast<int>(std::lround(radius_mm * std::cos(angle))),
                      static_cast<int>(std::lround(radius_mm * std::sin(angle))), i - 48,
                      static_cast<std::uint8_t>(i + 100), 0});
  }
  return points;
}

std::vector<ScanPoint> decode_packet(livox::Decoder& decoder, const std::vector<std::uint8_t>& bytes,
                                     std::int64_t since_start_ns = 0) {
  PacketColumns columns;
  REQUIRE(decoder.read(bytes, columns) == DecodeStatus::kOk);
  REQUIRE(columns.count == 1);
  std::vector<ScanPoint> points(decoder.points_per_column());
  points.resize(decoder.decode(bytes, columns, 0, 1, since_start_ns, points.data()));
  return points;
}

}  // namespace

TEST_CASE("Points of type 1 and 2 are those that were encoded, at even times from the packet's stamp") {
  const auto truth = circle(12'340);
  for (const bool is_short : {false, true}) {
    CAPTURE(is_short);
    LivoxPacket packet;
    packet.timestamp_ns = 5'000'000;
    livox::Decoder decoder;
    const auto points =
        decode_packet(decoder, is_short ? packet.short_points(truth) : packet.points(truth), 1'000'000);
    REQUIRE(points.size() == truth.size());
    // Type 2 is rounded towards 0 to a centimetre; floats have steps of 1e-6 m at 12 m.
    const double tolerance_m = is_short ? 0.01 : 2e-6;
    for (std::size_t i = 0; i < points.size(); ++i) {
      CHECK(std::abs(points[i].x_m - truth[i].x_mm * 1e-3) <= tolerance_m);
      CHECK(std::abs(points[i].y_m - truth[i].y_mm * 1e-3) <= tolerance_m);
      CHECK(std::abs(points[i].z_m - truth[i].z_mm * 1e-3) <= tolerance_m);
      CHECK(points[i].intensity == truth[i].reflectivity);
      CHECK(int{points[i].ring} == 0);
      // 475 us over 95 steps; 4 us resolution.
      CHECK(std::abs(points[i].time_4us * 4.0 - (1'000.0 + 5.0 * static_cast<double>(i))) <= 2.0);
    }
  }
}

TEST_CASE("Points without a return, of low confidence, out of range and in the mask are dropped") {
  LidarLimits limits;
  limits.min_range_m = 1.0;
  limits.max_range_m = 50.0;
  limits.mask_start_deg = 80.0;
  limits.mask_end_deg = 100.0;  // to the right, y < 0
  livox::Decoder decoder(limits);
  std::vector<LivoxPoint> points{{0, 0, 0, 1, 0},         {999, 0, 0, 2, 0},       {1'000, 0, 0, 3, 0},
                                 {50'001, 0, 0, 4, 0},    {0, -5'000, 0, 5, 0},    {0, 5'000, 0, 6, 0},
                                 {5'000, 0, 0, 7, 0x02},  {5'000, 0, 0, 8, 0x08},  {5'000, 0, 0, 9, 0x20},
                                 {5'000, 0, 0, 10, 0x15}, {900, -5'000, 0, 11, 0}, {0, 0, 5'000, 12, 0}};
  std::string kept;
  for (const ScanPoint& point : decode_packet(decoder, LivoxPacket{}.points(points))) {
    kept += std::to_string(point.intensity) + " ";
  }
  CHECK(kept == "3 6 10 11 12 ");
}

TEST_CASE("A frame is a slice of 100 ms of the sensor's time") {
  ScanAssembler assembler(std::make_unique<livox::Decoder>());
  auto scan = std::make_unique<Scan>();
  LivoxPacket packet;
  packet.timestamp_ns = 3'050'000'000;
  std::vector<std::uint32_t> counts;
  std::vector<std::int64_t> starts;
  for (int i = 0; i < 1'000; ++i) {
    const auto host_ns = kHostNs + static_cast<std::int64_t>(packet.timestamp_ns);
    const DecodeResult result = assembler.add_packet(packet.points(circle(8'000)), host_ns, *scan);
    CHECK(result.status == DecodeStatus::kOk);
    if (result.scan_complete) {
      counts.push_back(scan->point_count);
      starts.push_back(scan->stamp_ns - kHostNs);
    }
    packet.timestamp_ns += 480'000;
    ++packet.udp_cnt;
  }
  CHECK(assembler.counters().lost == 0);
  CHECK(assembler.counters().packets == 1'000);
  REQUIRE(counts.size() == 5);
  for (std::size_t i = 1; i < counts.size(); ++i) {
    CHECK(std::abs(static_cast<int>(counts[i]) - 20'000) <= 96);
    CHECK(starts[i] % 100'000'000 < 480'000);  // the first packet of the slice
  }
}

TEST_CASE("Lost and repeated packets are counted") {
  ScanAssembler assembler(std::make_unique<livox::Decoder>());
  const auto scan = std::make_unique<Scan>();
  LivoxPacket packet;
  packet.timestamp_ns = 1'000'000'000;
  for (int i = 0; i < 100; ++i) {
    if (i != 40 && i != 41 && i != 70) {
      const auto host_ns = kHostNs + static_cast<std::int64_t>(packet.timestamp_ns);
      assembler.add_packet(packet.points(circle(8'000)), host_ns, *scan);
      if (i == 20) assembler.add_packet(packet.points(circle(8'000)), host_ns, *scan);
    }
    packet.timestamp_ns += 480'000;
  }
  CHECK(assembler.counters().lost == 3);
  CHECK(assembler.counters().duplicated == 1);
}

TEST_CASE("IMU packets give a sample in m/s2 and rad/s on the robot's clock") {
  ScanAssembler assembler(std::make_unique<livox::Decoder>());
  const auto scan = std::make_unique<Scan>();
  LivoxPacket packet;
  packet.timestamp_ns = 1'000'000'000;
  packet.time_type = 1;
  ImuSample sample;
  assembler.add_packet(packet.points(circle(8'000)), kHostNs, *scan);
  packet.timestamp_ns += 250'000;
  CHECK(assembler.add_packet(packet.imu({0.1F, -0.2F, 0.3F}, {0.0F, 0.5F, 1.0F}), kHostNs + 250'000, *scan)
            .status == DecodeStatus::kNoPoints);
  REQUIRE(assembler.take_imu(sample));
  CHECK(!assembler.take_imu(sample));
  CHECK((sample.gyro_rad_s - Eigen::Vector3d(0.1, -0.2, 0.3)).norm() < 1e-7);
  CHECK((sample.accel_m_s2 - Eigen::Vector3d(0.0, 4.903325, 9.80665)).norm() < 1e-6);
  CHECK(sample.stamp_ns == kHostNs + 250'000);
  CHECK(assembler.decoder().sync() == LidarSync::kLocked);
  assembler.add_packet(packet.imu({0.1F, -0.2F, std::nanf("")}, {0.0F, 0.5F, 1.0F}), kHostNs + 250'000,
                       *scan);
  CHECK(!assembler.take_imu(sample));
}

TEST_CASE("A wrong checksum is garbage, once a right one has been seen or at the start") {
  livox::Decoder decoder;
  LivoxPacket packet;
  PacketColumns columns;
  auto bad = packet.points(circle(5'000));
  bad[200] = static_cast<std::uint8_t>(bad[200] ^ 1U);
  CHECK(decoder.read(bad, columns) == DecodeStatus::kGarbage);
  CHECK(decoder.read(packet.points(circle(5'000)), columns) == DecodeStatus::kOk);
  for (int i = 0; i < 200; ++i) CHECK(decoder.read(bad, columns) == DecodeStatus::kGarbage);
}

TEST_CASE("Checksums that are never right, or 0, are not looked at: no firmware makes the sensor useless") {
  livox::Decoder decoder;
  LivoxPacket packet;
  PacketColumns columns;
  auto none = packet.points(circle(5'000));
  for (std::size_t i = 24; i < 28; ++i) none[i] = 0;
  CHECK(decoder.read(none, columns) == DecodeStatus::kOk);
  auto other = none;
  other[24] = 77;
  for (int i = 0; i < 64; ++i) CHECK(decoder.read(other, columns) == DecodeStatus::kGarbage);
  CHECK(decoder.read(other, columns) == DecodeStatus::kOk);
}

TEST_CASE("Contradicting fields, short and long packets and other point types are told apart") {
  livox::Decoder decoder;
  LivoxPacket packet;
  PacketColumns columns;
  const auto good = packet.points(circle(5'000));
  const auto status_with = [&](std::size_t at, std::uint8_t value) {
    auto bytes = good;
    bytes[at] = value;
    return decoder.read(bytes, columns);
  };
  CHECK(status_with(0, 5) == DecodeStatus::kGarbage);      // version
  CHECK(status_with(5, 95) == DecodeStatus::kGarbage);     // number of points
  CHECK(status_with(10, 2) == DecodeStatus::kGarbage);     // type
  CHECK(status_with(10, 0x11) == DecodeStatus::kGarbage);  // unknown type
  CHECK(status_with(35, 0xF0) == DecodeStatus::kGarbage);  // timestamp
  auto bytes = good;
  bytes.pop_back();
  CHECK(decoder.read(bytes, columns) == DecodeStatus::kTruncated);
  bytes.resize(good.size() + 1);
  CHECK(decoder.read(bytes, columns) == DecodeStatus::kOversized);
  CHECK(decoder.read({}, columns) == DecodeStatus::kTruncated);
  const auto spherical = packet.finish(3, 2, std::vector<std::uint8_t>(20));
  CHECK(decoder.read(spherical, columns) == DecodeStatus::kWrongModel);
  CHECK(decoder.mismatch() ==
        "points of type 3, but types 1 and 2 are decoded: set the sensor to Cartesian coordinates "
        "(pcl_data_type)");
  CHECK(decoder.is_data(good));
  CHECK(!decoder.is_data(spherical));
}

}  // namespace isobar::test::test_livox_decoder

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "core/geometry.hpp"
#include "drivers/hesai/decoder.hpp"
#include "drivers/lidar/civil_time.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "tests/drivers/hesai/packet_builder.hpp"

namespace isobar::test::test_hesai {
namespace {

using hesai::kXt16;
using hesai::kXt32;

constexpr std::int64_t kHostStart = 1'700'000'000'000'000'000;

std::vector<ScanPoint> points_of(hesai::Decoder& decoder, const std::vector<std::uint8_t>& bytes) {
  PacketColumns packet;
  REQUIRE(decoder.read(bytes, packet) == DecodeStatus::kOk);
  std::vector<ScanPoint> points(static_cast<std::size_t>(packet.count) * decoder.points_per_column());
  points.resize(decoder.decode(bytes, packet, 0, packet.count, 0, points.data()));
  return points;
}

}  // namespace

TEST_CASE(
    "Each return has the manual's position: block azimuth from the y axis to the right, channel 1 highest") {
  for (const hesai::ModelTraits* traits : {&kXt16, &kXt32}) {
    hesai::Decoder decoder(*traits);
    HesaiPlan plan;
    plan.lasers = traits->lasers;
    plan.first_azimuth_deg = 30.0;
    plan.distance = [](int block, int channel) {
      return static_cast<std::uint16_t>(500 + 40 * block + channel);
    };
    const auto points = points_of(decoder, build_packet(plan));
    REQUIRE(points.size() == static_cast<std::size_t>(8 * traits->lasers));
    const double elevation_step_deg = traits->lasers == 16 ? 2.0 : 1.0;
    const double step_us = traits->lasers == 16 ? 3.024 : 1.512;
    for (int block = 0; block < 8; ++block) {
      for (int channel = 0; channel < traits->lasers; ++channel) {
        const ScanPoint& p = points[static_cast<std::size_t>(block * traits->lasers + channel)];
        const double azimuth = (30.0 + 0.18 * block) * kRadPerDeg;
        const double elevation = (15.0 - elevation_step_deg * channel) * kRadPerDeg;
        const double range_m = 0.004 * (500 + 40 * block + channel);
        // Single precision of some metres.
        CHECK(std::hypot(p.x_m - range_m * std::cos(elevation) * std::sin(azimuth),
                         p.y_m - range_m * std::cos(elevation) * std::cos(azimuth),
                         p.z_m - range_m * std::sin(elevation)) < 2e-6);
        CHECK(std::abs(p.time_4us * 4.0 - (50.0 * block + step_us * channel)) <= 2.01);
        CHECK(p.ring == traits->lasers - 1 - channel);
        CHECK(p.intensity == channel);
      }
    }
  }
}

TEST_CASE("The packet's time is that of the last firing, 5.6 us before its lasers begin") {
  hesai::Decoder decoder(kXt16);
  PacketColumns packet;
  HesaiPlan plan;
  plan.microsecond = 250'000;
  REQUIRE(decoder.read(build_packet(plan), packet) == DecodeStatus::kOk);
  // 2024-11-29 02:42:07.25 UTC is 1732848127.25 s after the epoch (date -u -d … +%s).
  CHECK(packet.device_ns == 1'732'848'127'250'000'000 + 5'632 + 368 - 7 * 50'000);
  plan.return_mode = 0x39;
  REQUIRE(decoder.read(build_packet(plan), packet) == DecodeStatus::kOk);
  CHECK(packet.device_ns == 1'732'848'127'250'000'000 + 5'632 + 368 - 3 * 50'000);
  CHECK(packet.offset_ns[7] == 150'000);
}

TEST_CASE("Dates count as the calendar does, across leap years and centuries") {
  CHECK(CivilTime{1970, 1, 1, 0, 0, 0, 5}.since_epoch_ns() == 5);
  CHECK(CivilTime{2000, 2, 29, 12, 0, 0, 0}.since_epoch_ns() == 951'825'600'000'000'000);
  CHECK(CivilTime{2026, 12, 31, 23, 59, 59, 0}.since_epoch_ns() == 1'798'761'599'000'000'000);
  CHECK(CivilTime{2100, 3, 1, 0, 0, 0, 0}.since_epoch_ns() == 4'107'542'400'000'000'000);
}

TEST_CASE("In dual return equal returns of a firing are one point") {
  hesai::Decoder decoder(kXt16);
  HesaiPlan plan;
  plan.return_mode = 0x3C;
  plan.distance = [](int block, int channel) {
    return static_cast<std::uint16_t>(channel < 4 && block % 2 == 1 ? 900 : 1'000);
  };
  CHECK(points_of(decoder, build_packet(plan)).size() == 4 * (16 + 4));
}

TEST_CASE("The angles of a correction table turn and lift the beams of their channels") {
  AngleTable table;
  for (int i = 0; i < 16; ++i) {
    table.elevation_deg.push_back(14.9 - 2.01 * i);
    table.azimuth_deg.push_back(0.123 * i - 1.0);
  }
  hesai::Decoder decoder(kXt16, {}, table);
  HesaiPlan plan;
  plan.first_azimuth_deg = 359.9;
  const auto points = points_of(decoder, build_packet(plan));
  for (std::size_t i = 0; i < 16; ++i) {
    const double azimuth = (359.9 + table.azimuth_deg[i]) * kRadPerDeg;
    const double elevation = table.elevation_deg[i] * kRadPerDeg;
    CHECK(std::hypot(points[i].x_m - 4.0 * std::cos(elevation) * std::sin(azimuth),
                     points[i].y_m - 4.0 * std::cos(elevation) * std::cos(azimuth),
                     points[i].z_m - 4.0 * std::sin(elevation)) < 2e-6);
  }
}

TEST_CASE("Wrong models, sizes and fields are refused by kind; good packets around them are decoded") {
  ScanAssembler assembler(std::make_unique<hesai::Decoder>(kXt16));
  const auto scan = std::make_unique<Scan>();
  std::int64_t now_ns = kHostStart;
  const auto add = [&](std::vector<std::uint8_t> bytes) {
    now_ns += 400'000;
    return assembler.add_packet(bytes, now_ns, *scan).status;
  };
  HesaiPlan plan;
  const auto good = [&plan](int n) {
    plan.microsecond = static_cast<std::uint32_t>(400 * n);
    plan.first_azimuth_deg = 1.44 * n;
    return build_packet(plan);
  };
  CHECK(add(good(1)) == DecodeStatus::kOk);
  HesaiPlan other;
  other.lasers = 32;
  CHECK(add(build_packet(other)) == DecodeStatus::kWrongModel);
  CHECK(assembler.decoder().mismatch() ==
        "packets of a Hesai with 32 lasers, protocol 6.1, but XT16 is configured");
  auto bytes = good(2);
  bytes.resize(500);
  CHECK(add(bytes) == DecodeStatus::kTruncated);
  bytes = good(2);
  bytes.push_back(0);
  CHECK(add(bytes) == DecodeStatus::kOversized);
  bytes = good(2);
  bytes[13] = 0xFF;  // azimuth above 360 deg
  CHECK(add(bytes) == DecodeStatus::kGarbage);
  bytes = good(2);
  bytes[540 + 14] = 13;  // month
  CHECK(add(bytes) == DecodeStatus::kGarbage);
  CHECK(add(good(2)) == DecodeStatus::kOk);
  CHECK(add(good(2)) == DecodeStatus::kDuplicate);
  CHECK(assembler.counters().packets == 2);
  CHECK(assembler.counters().lost == 0);
}

}  // namespace isobar::test::test_hesai

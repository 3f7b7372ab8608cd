// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "core/geometry.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/robosense/decoder.hpp"
#include "tests/drivers/robosense/packet_builder.hpp"

namespace isobar::test::test_robosense {
namespace {

using robosense::kHelios16p;
using robosense::kRs16;

const std::vector<int> kElevations{1494, 1303, 1092, 890,  696,  546,  398,  267,
                                   133,  0,    -133, -267, -396, -523, -663, -801};
const std::vector<int> kAzimuths{-405, 361, -400, 358, -397, 356, -396, 355,
                                 -395, 355, -395, 355, -396, 356, -397, 357};

struct Packet {
  PacketColumns columns;
  std::vector<ScanPoint> points;
};

Packet read(robosense::Decoder& decoder, const std::vector<std::uint8_t>& bytes) {
  Packet packet;
  REQUIRE(decoder.read(bytes, packet.columns) == DecodeStatus::kOk);
  packet.points.resize(12 * 32);
  packet.points.resize(
      decoder.decode(bytes, packet.columns, 0, packet.columns.count, 0, packet.points.data()));
  return packet;
}

/// Position by the manual: the beam begins on a circle of `radius_m` at the head's azimuth.
double error_m(const ScanPoint& p, double range_m, double elevation_deg, double head_deg, double ahead_deg,
               double radius_m) {
  const double elevation = elevation_deg * kRadPerDeg;
  const double head = head_deg * kRadPerDeg;
  const double azimuth = (head_deg + ahead_deg) * kRadPerDeg;
  return std::hypot(p.x_m - range_m * std::cos(elevation) * std::cos(azimuth) - radius_m * std::cos(head),
                    p.y_m + range_m * std::cos(elevation) * std::sin(azimuth) + radius_m * std::sin(head),
                    p.z_m - range_m * std::sin(elevation));
}

}  // namespace

TEST_CASE("A Helios-16P's beams have the angles of its own device information, two firings in a block") {
  robosense::Decoder decoder(kHelios16p);
  PacketColumns none;
  CHECK_FALSE(decoder.has_own_angles());
  CHECK(decoder.read(build_helios_difop(kElevations, kAzimuths, 4), none) == DecodeStatus::kNoPoints);
  CHECK(decoder.has_own_angles());
  CHECK(decoder.sync() == LidarSync::kLocked);
  RobosensePlan plan;
  plan.first_azimuth_deg = 100.0;
  const Packet packet = read(decoder, build_packet(plan));
  CHECK(packet.columns.device_ns == 1'732'848'127'250'000'000);
  REQUIRE(packet.points.size() == 12 * 32);
  constexpr double kFireUs[16] = {0,     3.15,  6.30,  9.45,  13.26, 17.08, 20.56, 23.71,
                                  26.53, 27.77, 31.49, 32.73, 36.46, 38.94, 41.42, 43.91};
  for (int block = 0; block < 12; ++block) {
    for (int channel = 0; channel < 32; ++channel) {
      const auto laser = static_cast<std::size_t>(channel % 16);
      const double since_us = kFireUs[laser] + (channel / 16) * 55.56;
      const double head_deg = 100.0 + 0.4 * block + std::floor(40.0 * since_us / 111.12 + 1e-9) * 0.01;
      const ScanPoint& p = packet.points[static_cast<std::size_t>(block * 32 + channel)];
      CHECK(error_m(p, 5.0, 0.01 * kElevations[laser], head_deg, 0.01 * kAzimuths[laser], 0.03498) < 3e-6);
      CHECK(std::abs(p.time_4us * 4.0 - (111.12 * block + since_us)) <= 2.01);
      CHECK(p.ring == 15 - static_cast<int>(laser));
      CHECK(p.intensity == channel);
    }
  }
}

TEST_CASE("In dual return a block is one firing with two returns, and equal ones are one point") {
  robosense::Decoder decoder(kHelios16p);
  PacketColumns none;
  (void)decoder.read(build_helios_difop(kElevations, kAzimuths, 0), none);
  RobosensePlan plan;
  plan.step_deg = 0.2;
  plan.distance = [](int, int channel) { return static_cast<std::uint16_t>(channel < 24 ? 2'000 : 2'400); };
  (void)read(decoder, build_packet(plan));
  plan.time_us += 667;  // 12 blocks of 55.56 us
  plan.first_azimuth_deg = 2.4;
  const Packet packet = read(decoder, build_packet(plan));
  CHECK(packet.columns.offset_ns[1] == 55'560);
  REQUIRE(packet.points.size() == 12 * 24);  // channels 24 … 31 are the second returns of lasers 8 … 15
  CHECK(packet.points[16].time_4us == packet.points[8].time_4us);
}

TEST_CASE("An RS-LiDAR-16 counts its time by the calendar and its lasers from below, then from above") {
  robosense::Decoder decoder(kRs16);
  RobosensePlan plan;
  plan.is_helios = false;
  const Packet packet = read(decoder, build_packet(plan));
  CHECK(packet.columns.device_ns == 1'732'848'127'250'000'000);
  for (std::size_t laser = 0; laser < 16; ++laser) {
    const double elevation_deg =
        laser < 8 ? -15.0 + 2.0 * static_cast<double>(laser) : 31.0 - 2.0 * static_cast<double>(laser);
    const double head_deg = std::floor(40.0 * 2.8 * static_cast<double>(laser) / 111.0 + 1e-9) * 0.01;
    CHECK(error_m(packet.points[laser], 10.0, elevation_deg, head_deg, 0.0, 0.03825) < 3e-6);
    CHECK(packet.points[laser].ring == static_cast<int>(std::lround((elevation_deg + 15.0) / 2.0)));
  }
  // Angles of the sensor: 24 bits of 0.0001 deg, the first eight negative.
  std::vector<std::uint8_t> difop{0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
  difop.resize(300);
  difop.push_back(1);
  difop.resize(1'165);
  for (int laser = 0; laser < 16; ++laser)
    put_big(difop, static_cast<std::uint64_t>(10'123 * (16 - laser)), 3);
  difop.resize(1'248);
  PacketColumns none;
  CHECK(decoder.read(difop, none) == DecodeStatus::kNoPoints);
  const Packet again = read(decoder, build_packet(plan));
  CHECK(again.points[0].z_m == doctest::Approx(10.0 * std::sin(-16.1968 * kRadPerDeg)).epsilon(1e-6));
  CHECK(again.points[15].z_m == doctest::Approx(10.0 * std::sin(1.0123 * kRadPerDeg)).epsilon(1e-6));
}

TEST_CASE("Device information whose angles cannot be is said and leaves the angles in force") {
  robosense::Decoder decoder(kHelios16p);
  auto elevations = kElevations;
  elevations[3] = elevations[2];
  PacketColumns none;
  CHECK(decoder.read(build_helios_difop(elevations, kAzimuths, 4), none) == DecodeStatus::kNoPoints);
  CHECK_FALSE(decoder.has_own_angles());
  CHECK(decoder.mismatch() ==
        "device information without usable angles: channel 4: has the elevation of channel 3");
}

TEST_CASE("A pace that is not the return mode's is said once it is certain, and no longer when it fits") {
  robosense::Decoder decoder(kHelios16p);
  RobosensePlan plan;
  // A block is two firings of 55.56 us in single return, one in dual return.
  const auto send = [&](int packets, std::int64_t packet_us) {
    for (int i = 0; i < packets; ++i) {
      (void)read(decoder, build_packet(plan));
      plan.time_us += packet_us;
    }
  };
  constexpr std::int64_t kSingleUs = 1'333;
  constexpr std::int64_t kDualUs = 667;
  constexpr std::uint8_t kDual = 0;
  constexpr std::uint8_t kStrongest = 4;
  PacketColumns none;
  send(200, kDualUs);
  CHECK(decoder.contradiction() == nullptr);  // the mode is not known
  (void)decoder.read(build_helios_difop(kElevations, kAzimuths, kStrongest), none);
  send(50, kDualUs);
  CHECK(decoder.contradiction() == nullptr);
  send(100, kDualUs);
  REQUIRE(decoder.contradiction() != nullptr);
  CHECK(std::string(decoder.contradiction()) ==
        "it sends twice the packets of the single return that its device information names: set its return "
        "mode again");
  (void)decoder.read(build_helios_difop(kElevations, kAzimuths, kDual), none);
  send(2, kDualUs);
  CHECK(decoder.contradiction() == nullptr);
  send(200, kSingleUs);
  REQUIRE(decoder.contradiction() != nullptr);
  CHECK(std::string(decoder.contradiction()).starts_with("it sends half the packets of the dual return"));
  (void)decoder.read(build_helios_difop(kElevations, kAzimuths, kStrongest), none);
  send(200, kSingleUs);
  CHECK(decoder.contradiction() == nullptr);
}

TEST_CASE("Packets of another RoboSense, garbage and other sizes are refused by kind") {
  robosense::Decoder decoder(kHelios16p);
  PacketColumns packet;
  RobosensePlan plan;
  plan.is_helios = false;
  CHECK(decoder.read(build_packet(plan), packet) == DecodeStatus::kWrongModel);
  plan.is_helios = true;
  auto bytes = build_packet(plan);
  bytes[42 + 300] = 0;
  CHECK(decoder.read(bytes, packet) == DecodeStatus::kGarbage);
  bytes = build_packet(plan);
  bytes[26] = 0xFF;  // microseconds
  CHECK(decoder.read(bytes, packet) == DecodeStatus::kGarbage);
  bytes.pop_back();
  CHECK(decoder.read(bytes, packet) == DecodeStatus::kTruncated);
  bytes.resize(1'249);
  CHECK(decoder.read(bytes, packet) == DecodeStatus::kOversized);
}

}  // namespace isobar::test::test_robosense

// SPDX-License-Identifier: BSD-3-Clause
// Packets whose fields are valid one by one and impossible together: a turn that stands and leaps, a clock that runs
// back by minutes.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "tests/drivers/velodyne/packet_builder.hpp"
#include "tests/drivers/velodyne/velodyne_stream.hpp"

namespace isobar::test::test_impossible_packets {
namespace {

constexpr std::int64_t kHostStart = 1'700'000'000'000'000'000;
/// What ScanPoint::time_4us can say: 2^16 x 4 us, and the packet that exceeds it [ns].
constexpr std::int64_t kLongestScanNs = 262'144'000 + 2'000'000;

/// A packet whose blocks turn by step_deg, and in one of four by half a turn.
PacketPlan leaping_plan(std::mt19937& random, double step_deg) {
  PacketPlan plan;
  double azimuth_deg = std::uniform_real_distribution(0.0, 359.0)(random);
  for (int block = 0; block < 12; ++block) {
    azimuth_deg += random() % 4 == 0 ? 180.0 : step_deg;
    plan.azimuths_deg.push_back(std::fmod(azimuth_deg, 360.0));
  }
  return plan;
}

}  // namespace

TEST_CASE("No scan lasts longer than its points' times can say, whatever azimuths and stamps say together") {
  std::mt19937 random(5);  // NOLINT(bugprone-random-generator-seed): the same packets in every run
  VelodyneStream stream;
  const auto scan = std::make_unique<Scan>();
  std::uint64_t scans = 0;
  std::int64_t host_ns = kHostStart;
  std::uint32_t device_us = 0;
  const auto check = [&] {
    ++scans;
    const std::int64_t length_ns = scan->end_stamp_ns - scan->stamp_ns;
    CHECK(length_ns >= 0);
    CHECK(length_ns <= kLongestScanNs);
  };
  for (int packet = 0; packet < 20'000; ++packet) {
    // Turning at 10 Hz, or nearly standing: 0.01 deg in a block of 110 us is a turn in four seconds.
    PacketPlan plan = leaping_plan(random, random() % 2 == 0 ? 0.4 : 0.01);
    if (random() % 2 == 0) plan.azimuths_deg.clear();  // regular
    constexpr std::uint32_t kHourUs = 3'600'000'000U;
    const std::uint32_t choice = random() % 8;
    device_us = (device_us + (choice == 0   ? 263'144U                // ahead by a scan
                              : choice == 1 ? kHourUs - 130'000'000U  // back by two minutes
                              : choice == 2 ? random() % kHourUs
                                            : 1'327U)) %
                kHourUs;
    plan.timestamp_us = device_us;
    host_ns += 1'327'000;
    if (stream.add_packet(build_packet(plan), host_ns, *scan).scan_complete) check();
  }
  if (stream.flush(*scan)) check();
  CHECK(scans > 1'000);
}

TEST_CASE("A packet that is late by its clock but lies minutes after the open scan is too late for it") {
  VelodyneStream stream;
  const auto scan = std::make_unique<Scan>();
  // The clock leaps ahead and then back by two minutes, both too early to be believed; then it goes on as before.
  constexpr std::array<std::uint32_t, 4> kStampsUs{0, 263'144, 3'469'659'854U, 1'000};
  std::int64_t host_ns = kHostStart;
  for (std::size_t packet = 0; packet < kStampsUs.size(); ++packet) {
    PacketPlan plan;
    plan.first_azimuth_deg = 10.0 * static_cast<double>(packet);
    plan.timestamp_us = kStampsUs[packet];
    stream.add_packet(build_packet(plan), host_ns, *scan);
    host_ns += 1'327'000;
  }
  CHECK(stream.counters().too_late == 1);
  REQUIRE(stream.flush(*scan));
  CHECK(scan->end_stamp_ns - scan->stamp_ns <= kLongestScanNs);
}

}  // namespace isobar::test::test_impossible_packets

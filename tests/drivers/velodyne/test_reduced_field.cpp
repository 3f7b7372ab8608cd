// SPDX-License-Identifier: BSD-3-Clause
// A VLP-16 that is set to a sector: it sends the firings of the sector only, in full packets.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "tests/drivers/velodyne/packet_builder.hpp"
#include "tests/drivers/velodyne/velodyne_stream.hpp"

namespace isobar::test::test_reduced_field {
namespace {

constexpr std::int64_t kHostStart = 1'700'000'000'000'000'000;
constexpr double kBlockUs = 110.592;            // two firings of 55.296 us
constexpr double kStepDeg = kBlockUs * 0.0036;  // at 3600 deg a second

struct Sent {
  std::vector<std::uint8_t> bytes;
  std::int64_t stamp_ns = 0;
  double first_deg = 0.0;  // unwrapped
};

/// Packets of `turns` turns, of the blocks within start … start + width only. A packet is sent when its twelfth
/// block has fired; its first blocks may then be those of the turn before.
std::vector<Sent> packets_of(double start_deg, double width_deg, int turns) {
  std::vector<Sent> sent;
  std::vector<int> blocks;
  for (int block = 0; block * kStepDeg < 360.0 * turns; ++block) {
    const double into = std::fmod(block * kStepDeg - start_deg + 720.0, 360.0);
    if (into < width_deg) blocks.push_back(block);
    if (blocks.size() < 12) continue;
    PacketPlan plan;
    plan.azimuths_deg.clear();
    for (const int b : blocks) plan.azimuths_deg.push_back(std::fmod(b * kStepDeg, 360.0));
    plan.timestamp_us = static_cast<std::uint32_t>(blocks.front() * kBlockUs);
    sent.push_back({build_packet(plan),
                    kHostStart + static_cast<std::int64_t>((blocks.back() + 1) * kBlockUs * 1e3),
                    blocks.front() * kStepDeg});
    blocks.clear();
  }
  return sent;
}

struct Outcome {
  std::vector<std::unique_ptr<Scan>> scans;
  std::vector<std::int64_t> completed_ns;
  LidarCounters counters;
};

Outcome run(const std::vector<Sent>& packets) {
  Outcome outcome;
  VelodyneStream stream;
  auto scan = std::make_unique<Scan>();
  for (const Sent& packet : packets) {
    if (stream.add_packet(packet.bytes, packet.stamp_ns, *scan).scan_complete) {
      outcome.scans.push_back(std::move(scan));
      outcome.completed_ns.push_back(packet.stamp_ns);
      scan = std::make_unique<Scan>();
    }
  }
  outcome.counters = stream.counters();
  return outcome;
}

}  // namespace

TEST_CASE(
    "A reduced field of view is no loss, gives one scan a turn, and completes it when the field was seen") {
  struct Field {
    double start_deg;
    double width_deg;
  };
  for (const Field& field :
       {Field{100.0, 160.0}, Field{300.0, 120.0}, Field{0.0, 90.0}, Field{20.0, 340.0}}) {
    CAPTURE(field.start_deg);
    const int turns = 40;
    const Outcome outcome = run(packets_of(field.start_deg, field.width_deg, turns));
    CHECK(outcome.counters.lost == 0);
    CHECK(outcome.counters.too_late == 0);
    // The sector is known after two turns; before, the cut at azimuth 0 may divide a field.
    CHECK(outcome.scans.size() >= turns - 3);
    CHECK(outcome.scans.size() <= turns + 3);
    for (std::size_t i = 5; i < outcome.scans.size(); ++i) {
      const Scan& scan = *outcome.scans[i];
      // All blocks of a field but those of the packet that is not full yet, which come with the next one.
      const double blocks = scan.point_count / 32.0;
      CHECK(std::abs(blocks - field.width_deg / kStepDeg) <= 13.0);
      // Received within the time of a packet, 1.33 ms, of its last point.
      CHECK(outcome.completed_ns[i] - scan.end_stamp_ns < 2'000'000);
      // The blocks that come late began with the field before: a turn earlier at most.
      CHECK(scan.end_stamp_ns - scan.stamp_ns < 110'000'000);
    }
  }
}

TEST_CASE("Packets that are lost in a reduced field of view are counted, the sector is not") {
  auto packets = packets_of(100.0, 160.0, 40);
  const std::size_t sent = packets.size();
  // Every 17th packet of the second half: not in step with the turns of 33 to 34 packets.
  std::vector<Sent> received;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (i > sent / 2 && i % 17 == 5) {
      ++dropped;
    } else {
      received.push_back(packets[i]);
    }
  }
  const Outcome outcome = run(received);
  // A packet lost at an end of the field may be taken for a changed end: one in the 14 of a field.
  CHECK(outcome.counters.lost >= dropped - 4);
  CHECK(outcome.counters.lost <= dropped + 2);
}

TEST_CASE("Bursts of loss at changing places are loss, not a reduced field of view") {
  auto packets = packets_of(0.0, 360.0, 40);
  std::vector<Sent> received;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const bool is_lost = i % 120 >= 100;  // 20 of 120 packets, 75 packets a turn
    dropped += is_lost ? 1 : 0;
    if (!is_lost) received.push_back(packets[i]);
  }
  const Outcome outcome = run(received);
  CHECK(outcome.counters.lost + 20 >= dropped);
  CHECK(outcome.counters.lost <= dropped);
  CHECK(outcome.scans.size() >= 38);
}

TEST_CASE("A field of view that is opened again gives whole turns") {
  auto packets = packets_of(100.0, 160.0, 20);
  const std::size_t narrow = packets.size();
  const auto whole = packets_of(0.0, 360.0, 40);
  for (const Sent& packet : whole) {
    if (packet.stamp_ns > packets[narrow - 1].stamp_ns) packets.push_back(packet);
  }
  const Outcome outcome = run(packets);
  CHECK(outcome.scans.size() >= 38);
  for (std::size_t i = outcome.scans.size() - 10; i < outcome.scans.size(); ++i) {
    CHECK(outcome.scans[i]->point_count == doctest::Approx(360.0 / kStepDeg * 32.0).epsilon(0.01));
  }
}

}  // namespace isobar::test::test_reduced_field

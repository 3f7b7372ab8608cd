// SPDX-License-Identifier: BSD-3-Clause
// The lidar's packets in shared memory: complete, without allocation, and cheap beside the decoding.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "daemon/input_tap.hpp"
#include "daemon/packet_tap.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/drivers/velodyne/packet_builder.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_packet_tap {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kPacketNs = 1'327'000;  // of a VLP-16
constexpr int kPackets = 600;

/// Packets of a turning VLP-16 with their arrival.
class Traffic {
 public:
  Traffic() {
    for (int i = 0; i < kPackets; ++i) {
      PacketPlan plan;
      plan.timestamp_us = static_cast<std::uint32_t>(i * kPacketNs / 1'000);
      plan.first_azimuth_deg = i * 4.8;
      packets_.push_back(build_packet(plan));
    }
  }
  [[nodiscard]] ReceivedDatagram operator[](int i) const {
    return {packets_[static_cast<std::size_t>(i)], kStart + i * kPacketNs, {0x0A00'0001U, 2'368}, false};
  }

 private:
  std::vector<std::vector<std::uint8_t>> packets_;
};

/// Time to decode one packet after `tap` has had it, over all packets [ns].
template <class Tap>
double round_ns(const Traffic& traffic, const Tap& tap) {
  static ScanAssembler decoder(make_lidar_decoder({}));
  static const auto scan = std::make_unique<Scan>();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kPackets; ++i) {
    const ReceivedDatagram datagram = traffic[i];
    tap(datagram);
    (void)decoder.add_packet(datagram.payload, datagram.stamp_ns, *scan);
  }
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
  return spent.count() / kPackets;
}

/// Median over some rounds of the time with `tap`, in terms of the time without in the same round.
template <class Tap, class Drain>
double cost(const Traffic& traffic, const Tap& tap, const Drain& drain) {
  constexpr int kRounds = 21;
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    const double without_ns = round_ns(traffic, [](const ReceivedDatagram&) {});
    ratios.push_back(round_ns(traffic, tap) / without_ns);
    drain();
  }
  std::nth_element(ratios.begin(), ratios.begin() + kRounds / 2, ratios.end());
  return ratios[kRounds / 2];
}

}  // namespace

TEST_CASE("a subscriber receives every packet unchanged, also the last ones before a silence") {
  const ipc::Broker broker;
  const Traffic traffic;
  PacketTap tap;
  InputTap inputs;
  recording::InputLog log;
  for (int i = 0; i < kPackets; ++i) {
    tap.add(traffic[i]);
    tap.end_round();
    if (i % 100 == 0) inputs.drain(log);
  }
  tap.end_round();  // no packet in this round
  inputs.drain(log);
  CHECK(inputs.lost() == 0);
  recording::InputLogReader reader(log.bytes());
  recording::LogEntry entry;
  int read = 0;
  for (; reader.next(entry); ++read) {
    const ReceivedDatagram sent = traffic[read];
    REQUIRE(entry.kind == recording::LogKind::kPacket);
    REQUIRE(entry.stamp_ns == sent.stamp_ns);
    REQUIRE(entry.sender_ipv4 == sent.sender.ipv4);
    REQUIRE(std::equal(entry.packet.begin(), entry.packet.end(), sent.payload.begin(), sent.payload.end()));
  }
  CHECK(read == kPackets);
}

TEST_CASE("packets that a full queue drops, and packets that are too long, are counted as lost") {
  const ipc::Broker broker;
  const Traffic traffic;
  PacketTap tap;
  InputTap inputs;
  recording::InputLog log;
  constexpr std::uint32_t kGroup = ipc::LidarPackets::kMaxPackets;
  const auto send_group = [&] {
    for (std::uint32_t i = 0; i < kGroup; ++i) tap.add(traffic[static_cast<int>(i)]);
  };
  send_group();
  inputs.drain(log);  // the first message: from here on gaps are seen
  for (std::uint32_t group = 0; group < ipc::topics::kLidarPackets.depth + 3; ++group) send_group();
  inputs.drain(log);
  CHECK(inputs.lost() == 3 * kGroup);
  const std::vector<std::uint8_t> long_payload(ipc::LidarPacket::kMaxBytes + 1);
  tap.add({long_payload, kStart, {}, false});
  send_group();
  inputs.drain(log);
  CHECK(inputs.lost() == 3 * kGroup + 1);
}

TEST_CASE("the tap allocates nothing and costs a fraction of the decoding") {
  const ipc::Broker broker;
  const Traffic traffic;
  PacketTap tap;
  const auto with_tap = [&](const ReceivedDatagram& datagram) { tap.add(datagram); };
  const double idle = cost(traffic, with_tap, [] {});
  InputTap inputs;
  recording::InputLog log;
  const double tapped = cost(traffic, with_tap, [&] {
    log.clear();
    inputs.drain(log);
  });
  MESSAGE("decoding with an idle tap takes " << idle << ", with a subscriber " << tapped << " times as long");
  CHECK(idle < 1.3);
  CHECK(tapped < 2.0);
  const std::size_t before = allocation_count();
  for (int i = 0; i < kPackets; ++i) {
    tap.add(traffic[i]);
    tap.end_round();
  }
  CHECK(allocation_count() == before);
}

}  // namespace isobar::test::test_packet_tap

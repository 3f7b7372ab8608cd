// SPDX-License-Identifier: BSD-3-Clause
// The lidar's packets in shared memory: complete, without allocation, and cheap beside the decoding.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
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

TEST_CASE("scans are taken only where they are the lidar's input") {
  const ipc::Broker broker;
  InputTap inputs;
  ipc::Publisher<Scan> publisher{ipc::topics::kLidarScan};
  const auto publish = [&](std::int64_t stamp_ns) {
    Scan* scan = publisher.loan();
    REQUIRE(scan != nullptr);
    scan->stamp_ns = stamp_ns;
    scan->point_count = 1;
    scan->points[0] = {1.0F, 2.0F, 3.0F, 4, 5, 6};
    publisher.publish(scan);
  };
  recording::InputLog log;
  publish(kStart);
  inputs.drain(log);
  CHECK(log.records() == 0);
  inputs.take_scans(true);
  publish(kStart + 1);
  inputs.drain(log);
  recording::InputLogReader reader(log.bytes());
  recording::LogEntry entry;
  REQUIRE(reader.next(entry));
  CHECK(entry.kind == recording::LogKind::kScanPart);
  CHECK(entry.stamp_ns == kStart + 1);
  CHECK(entry.scan_points == 1);
}

TEST_CASE("a subscriber receives every packet unchanged, also the last ones before a silence") {
  const ipc::Broker broker;
  const Traffic traffic;
  PacketTap tap;
  InputTap inputs;
  recording::InputLog log;
  for (int i = 0; i < kPackets; ++i) {
    tap.add(traffic[i], ipc::LidarPort::kData);
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

TEST_CASE(
    "packets of every length and of both ports arrive in their order, and one that is too long is counted") {
  const ipc::Broker broker;
  PacketTap tap;
  InputTap inputs;
  recording::InputLog log;
  constexpr std::size_t kTooLong = ipc::LidarPackets::kMaxBytes + 1;
  // One byte, IMU of Ouster, Velodyne, Ouster with 32 and 128 channels, the longest datagram of UDP, an empty one.
  const std::vector<std::size_t> sizes = {1,      48,     1'206, 12'608, 12'608, 24'896, 24'896,   48,
                                          33'024, 33'024, 1,     65'507, 0,      1'206,  kTooLong, 1'206};
  std::vector<std::vector<std::uint8_t>> sent;
  std::mt19937 random(1);
  const auto port_of = [](std::size_t i) {
    return i % 3 == 1 ? ipc::LidarPort::kInformation : ipc::LidarPort::kData;
  };
  constexpr std::size_t kRounds = 20;
  for (std::size_t i = 0; i < kRounds * sizes.size(); ++i) {
    std::vector<std::uint8_t> payload(sizes[i % sizes.size()]);
    for (auto& byte : payload) byte = static_cast<std::uint8_t>(random());
    tap.add({payload, kStart + static_cast<std::int64_t>(i), {static_cast<std::uint32_t>(i), 1}, false},
            port_of(i));
    tap.end_round();
    sent.push_back(std::move(payload));
    if (i % sizes.size() == 5) inputs.drain(log);
  }
  tap.end_round();
  inputs.drain(log);
  CHECK(inputs.lost() == kRounds);
  recording::InputLogReader reader(log.bytes());
  recording::LogEntry entry;
  std::size_t read = 0;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent[i].size() == kTooLong) continue;
    CAPTURE(i);
    REQUIRE(reader.next(entry));
    const bool is_information = port_of(i) == ipc::LidarPort::kInformation;
    REQUIRE(entry.kind == (is_information ? recording::LogKind::kInformation : recording::LogKind::kPacket));
    REQUIRE(entry.stamp_ns == kStart + static_cast<std::int64_t>(i));
    REQUIRE(entry.sender_ipv4 == i);
    REQUIRE(std::equal(entry.packet.begin(), entry.packet.end(), sent[i].begin(), sent[i].end()));
    ++read;
  }
  CHECK(read == sent.size() - kRounds);
  CHECK_FALSE(reader.next(entry));
}

TEST_CASE(
    "packets that a full queue drops are counted one by one, and a group is never older than its limit") {
  const ipc::Broker broker;
  const Traffic traffic;
  PacketTap tap;
  InputTap inputs;
  recording::InputLog log;
  constexpr int kGroup = PacketTap::kMaxAgeNs / kPacketNs + 2;  // the last one completes the span
  const auto send_group = [&] {
    for (int i = 0; i < kGroup; ++i) tap.add(traffic[i], ipc::LidarPort::kData);
  };
  send_group();
  inputs.drain(log);  // the first message: from here on gaps are seen
  CHECK(log.records() == kGroup);
  constexpr std::uint32_t kDropped = 3;
  for (std::uint32_t group = 0; group < ipc::topics::kLidarPackets.depth + kDropped; ++group) send_group();
  inputs.drain(log);
  CHECK(inputs.lost() == kDropped * kGroup);
  CHECK(log.records() == (ipc::topics::kLidarPackets.depth + 1) * kGroup);
}

TEST_CASE("the queue holds twice what the busiest lidar sends from one drain to the next") {
  const ipc::Broker broker;
  PacketTap tap;
  InputTap inputs;
  recording::InputLog log;
  const std::vector<std::uint8_t> longest(33'024);  // Ouster, 128 channels, dual return
  constexpr std::int64_t kFastestNs =
      1'000'000'000 / 1'280;  // 2048 columns at 10 Hz or 1024 at 20 Hz, 16 a packet
  std::int64_t now_ns = kStart;
  tap.add({longest, now_ns, {}, false}, ipc::LidarPort::kData);
  tap.end_round();
  tap.end_round();
  inputs.drain(log);
  std::uint64_t sent = 0;
  for (const std::int64_t end_ns = now_ns + 2 * InputTap::kDrainEveryNs; now_ns < end_ns;
       now_ns += kFastestNs) {
    tap.add({longest, now_ns, {}, false}, ipc::LidarPort::kData);
    ++sent;
  }
  tap.end_round();
  tap.end_round();
  log.clear();
  inputs.drain(log);
  CHECK(log.records() == sent);
  CHECK(inputs.lost() == 0);
}

TEST_CASE("the tap allocates nothing and costs a fraction of the decoding") {
  const ipc::Broker broker;
  const Traffic traffic;
  PacketTap tap;
  const auto with_tap = [&](const ReceivedDatagram& datagram) { tap.add(datagram, ipc::LidarPort::kData); };
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
    tap.add(traffic[i], ipc::LidarPort::kData);
    tap.end_round();
  }
  CHECK(allocation_count() == before);
}

}  // namespace isobar::test::test_packet_tap

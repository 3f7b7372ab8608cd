// SPDX-License-Identifier: BSD-3-Clause
// Two ports waited for together.
#include <doctest/doctest.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/clock/robot_clock.hpp"
#include "drivers/udp/udp_pair.hpp"

namespace isobar::test::test_udp_pair {

namespace {

constexpr std::uint16_t kFirstPort = 41'368;
constexpr std::uint16_t kSecondPort = 41'308;

std::vector<std::uint8_t> payload_of(std::uint8_t number) { return {number, 0xFF}; }

}  // namespace

TEST_CASE(
    "both ports are received, each datagram with its port, and a busy port does not hold the other back") {
  UdpPair pair("127.0.0.1", kFirstPort, kSecondPort);
  UdpSender first("127.0.0.1", kFirstPort);
  UdpSender second("127.0.0.1", kSecondPort);
  for (std::uint8_t i = 0; i < 40; ++i) REQUIRE(first.send(payload_of(i)));
  for (std::uint8_t i = 100; i < 110; ++i) REQUIRE(second.send(payload_of(i)));
  std::uint8_t next_first = 0;
  std::uint8_t next_second = 100;
  ReceivedDatagram datagram;
  for (int received = 0; received < 50; ++received) {
    REQUIRE(pair.receive(datagram, 2'000) == UdpPair::Status::kDatagram);
    std::uint8_t& next = datagram.second ? next_second : next_first;
    CHECK(datagram.payload[0] == next);  // each port in its order
    ++next;
    // They take turns: all ten of the second port come among the first 20.
    if (received == 19) CHECK(next_second == 110);
  }
  CHECK(pair.receive(datagram, 0) == UdpPair::Status::kTimeout);
  CHECK(pair.dropped_by_kernel() == 0);
}

TEST_CASE("a datagram of the second port ends the wait for the first one, as stop() does") {
  UdpPair pair("127.0.0.1", kFirstPort, kSecondPort);
  std::thread sender([] { UdpSender("127.0.0.1", kSecondPort).send(payload_of(7)); });
  ReceivedDatagram datagram;
  CHECK(pair.receive(datagram, -1) == UdpPair::Status::kDatagram);
  CHECK(datagram.second);
  sender.join();
  std::thread stopper([&pair] { pair.stop(); });
  CHECK(pair.receive(datagram, -1) == UdpPair::Status::kStopped);
  stopper.join();
}

TEST_CASE("a second port that another program holds is waited for while the first one receives") {
  std::optional<UdpReceiver> holder;
  holder.emplace("127.0.0.1", kSecondPort);
  UdpPair pair("127.0.0.1", kFirstPort, kSecondPort);
  CHECK_FALSE(pair.second()->waiting_for().empty());
  UdpSender first("127.0.0.1", kFirstPort);
  REQUIRE(first.send(payload_of(1)));
  ReceivedDatagram datagram;
  CHECK(pair.receive(datagram, 2'000) == UdpPair::Status::kDatagram);
  CHECK_FALSE(datagram.second);
  holder.reset();
  const std::int64_t released_ns = monotonic_ns();
  while (!pair.second()->waiting_for().empty() && monotonic_ns() - released_ns < 5'000'000'000) {
    CHECK(pair.receive(datagram, 5'000) == UdpPair::Status::kTimeout);
  }
  CHECK(monotonic_ns() - released_ns < 2'000'000'000);
  UdpSender second("127.0.0.1", kSecondPort);
  REQUIRE(second.send(payload_of(2)));
  CHECK(pair.receive(datagram, 2'000) == UdpPair::Status::kDatagram);
  CHECK(datagram.second);
}

TEST_CASE("without a second port the pair is one receiver") {
  UdpPair pair("127.0.0.1", kFirstPort, 0);
  CHECK(pair.second() == nullptr);
  UdpSender first("127.0.0.1", kFirstPort);
  REQUIRE(first.send(payload_of(3)));
  ReceivedDatagram datagram;
  CHECK(pair.receive(datagram, 2'000) == UdpPair::Status::kDatagram);
  CHECK_FALSE(datagram.second);
  CHECK(pair.receive(datagram, 1) == UdpPair::Status::kTimeout);
}

}  // namespace isobar::test::test_udp_pair

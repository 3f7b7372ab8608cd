// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "drivers/udp/udp.hpp"

namespace isobar::test::test_udp {

TEST_CASE("Datagrams arrive whole, in order and stamped on the robot clock") {
  UdpReceiver receiver("127.0.0.1", 0);
  UdpSender sender("127.0.0.1", receiver.port());
  const std::int64_t before_ns = RobotClock::now_ns();
  for (std::size_t i = 1; i <= 20; ++i) {
    const std::vector<std::uint8_t> payload(i * 70, static_cast<std::uint8_t>(i));
    REQUIRE(sender.send(payload));
  }
  std::int64_t last_ns = before_ns - 1'000'000;  // two clocks are read one after the other
  for (std::size_t i = 1; i <= 20; ++i) {
    ReceivedDatagram datagram;
    REQUIRE(receiver.receive(datagram, 2'000) == UdpReceiver::Status::kDatagram);
    CHECK(std::vector<std::uint8_t>(datagram.payload.begin(), datagram.payload.end()) ==
          std::vector<std::uint8_t>(i * 70, static_cast<std::uint8_t>(i)));
    CHECK(datagram.sender.ipv4 == 0x7F000001U);
    CHECK(datagram.stamp_ns >= last_ns - 1'000'000);
    CHECK(datagram.stamp_ns <= RobotClock::now_ns() + 1'000'000);
    last_ns = datagram.stamp_ns;
  }
  ReceivedDatagram none;
  CHECK(receiver.receive(none, 0) == UdpReceiver::Status::kTimeout);
  CHECK(receiver.dropped_by_kernel() == 0);
}

TEST_CASE("stop() from another thread ends an endless wait") {
  UdpReceiver receiver("127.0.0.1", 0);
  std::thread stopper([&receiver] { receiver.stop(); });
  ReceivedDatagram datagram;
  CHECK(receiver.receive(datagram, -1) == UdpReceiver::Status::kStopped);
  stopper.join();
  CHECK(receiver.receive(datagram, -1) == UdpReceiver::Status::kStopped);
}

TEST_CASE("A port in use is waited for, and taken within two seconds of its release") {
  std::optional<UdpReceiver> first;
  first.emplace("127.0.0.1", 0);
  const std::uint16_t port = first->port();
  UdpReceiver second("127.0.0.1", port);
  const std::string in_use = "127.0.0.1:" + std::to_string(port) + ": the port is in use by another program";
  CHECK(second.waiting_for().find(in_use) != std::string::npos);
  ReceivedDatagram datagram;
  CHECK(second.receive(datagram, 20) == UdpReceiver::Status::kTimeout);
  first.reset();
  const std::int64_t released_ns = monotonic_ns();
  while (!second.waiting_for().empty() && monotonic_ns() - released_ns < 5'000'000'000) {
    CHECK(second.receive(datagram, 200) == UdpReceiver::Status::kTimeout);
  }
  CHECK(monotonic_ns() - released_ns < 2'000'000'000);
  CHECK(second.waiting_for().empty());
  UdpSender sender("127.0.0.1", port);
  REQUIRE(sender.send(std::vector<std::uint8_t>(10, 1)));
  CHECK(second.receive(datagram, 2'000) == UdpReceiver::Status::kDatagram);
}

TEST_CASE("An address that no interface has is waited for, and stop() ends the wait") {
  UdpReceiver receiver("203.0.113.7", 2'368);
  CHECK(receiver.waiting_for().find("203.0.113.7:2368: no network interface") != std::string::npos);
  CHECK(receiver.port() == 2'368);
  std::thread stopper([&receiver] { receiver.stop(); });
  ReceivedDatagram datagram;
  UdpReceiver::Status status = UdpReceiver::Status::kTimeout;
  while (status == UdpReceiver::Status::kTimeout) status = receiver.receive(datagram, -1);
  CHECK(status == UdpReceiver::Status::kStopped);
  stopper.join();
}

TEST_CASE("An address that is none is an error of the configuration") {
  CHECK_THROWS_WITH_AS(UdpReceiver("localhost", 2'368), doctest::Contains("is not an IPv4 address"),
                       ServiceError);
  CHECK_THROWS_AS(UdpSender("300.1.1.1", 1), ServiceError);
}

TEST_CASE("Sending without a receiver is not an error") {
  UdpSender sender("127.0.0.1", 9);
  const std::vector<std::uint8_t> payload(10);
  for (int i = 0; i < 5; ++i) {
    CHECK(sender.send(payload));
  }
}

}  // namespace isobar::test::test_udp

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "drivers/udp/udp.hpp"

namespace isobar::test {

/// Faults of a link: probabilities for each datagram, and times without any.
struct LinkFaults {
  struct Span {
    double from_s;  ///< after the first datagram
    double to_s;
  };

  double drop = 0.0;
  double duplicate = 0.0;
  double reorder = 0.0;   ///< goes on after the next one
  double truncate = 0.0;  ///< loses a random part of its end, of one byte at least
  double corrupt = 0.0;   ///< its first 32 bytes become noise
  std::vector<Span> dark;
};

/// Datagrams by what became of them.
struct LinkCounts {
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;  ///< at random
  std::uint64_t dark = 0;     ///< in a dark span
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t truncated = 0;
  std::uint64_t corrupted = 0;
};

/// A dark span as it was, CLOCK_MONOTONIC.
struct DarkSpan {
  std::int64_t last_before_ns = 0;  ///< the last datagram that went on
  std::int64_t first_after_ns = 0;  ///< 0: still dark
};

/// Passes the datagrams of a port of 127.0.0.1 on to another one, over a bad link. A datagram has one fault at most;
/// which one, the seed decides. In a thread of its own.
class UdpProxy {
 public:
  UdpProxy(std::uint16_t from_port, std::uint16_t to_port, LinkFaults faults, std::uint32_t seed);
  ~UdpProxy();
  UdpProxy(const UdpProxy&) = delete;
  UdpProxy& operator=(const UdpProxy&) = delete;

  [[nodiscard]] LinkCounts counts() const;
  /// The dark spans that have begun.
  [[nodiscard]] std::vector<DarkSpan> dark_spans() const;

 private:
  void pass_on();
  void take(const std::vector<std::uint8_t>& bytes);
  void fault(std::vector<std::uint8_t> bytes);
  void send(const std::vector<std::uint8_t>& bytes);
  [[nodiscard]] bool is_dark(std::int64_t now_ns);

  UdpReceiver receiver_;
  UdpSender sender_;
  LinkFaults faults_;
  std::mt19937 random_;
  mutable std::mutex mutex_;
  LinkCounts counts_;
  std::vector<DarkSpan> spans_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_sent_ns_ = 0;
  std::vector<std::uint8_t> held_;  ///< goes on after the next one
  std::thread thread_;
};

}  // namespace isobar::test

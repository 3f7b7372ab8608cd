// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/udp/udp.hpp"

namespace isobar {

/// Status of a SenderLock: plain values, trivially copyable.
struct SenderStatus {
  SenderAddress in_use;          ///< ipv4 0: none heard yet
  SenderAddress other;           ///< the newest refused one; ipv4 0: none
  std::uint64_t refused = 0;     ///< packets or samples of other senders
  std::uint64_t takeovers = 0;   ///< changes of the sender in use
  std::int64_t other_ns = 0;     ///< last refusal, robot clock; 0: never
  std::int64_t takeover_ns = 0;  ///< last change of the sender in use, robot clock; 0: never
};

/// Admits one sender of a stream, so that two lidars, two drivers or forged datagrams are never mixed.
///
/// The first sender heard is used, or the configured ones only. Another address takes over after the one in use
/// was silent for kTakeoverNs. Another port of the same address is the same program, restarted, or one that
/// opens a socket for each datagram. It is admitted as soon as the port in use has missed three of its samples, at
/// once if that one has sent once only; but when the earlier port sends again, both are alive, and the earlier one
/// alone is used until it was silent for kTakeoverNs. No allocation after construction; one thread.
class SenderLock {
 public:
  /// Silence after which another sender takes over [ns]: longer than a restart of a driver or a lost link.
  static constexpr std::int64_t kTakeoverNs = 5'000'000'000;
  /// Shortest and longest wait for the port in use before another one of its address is admitted [ns].
  static constexpr std::int64_t kLeastPortWaitNs = 20'000'000;
  static constexpr std::int64_t kMostPortWaitNs = 500'000'000;

  /// @param allowed addresses that may be used; empty: any
  explicit SenderLock(std::vector<std::uint32_t> allowed = {}) : allowed_(std::move(allowed)) {}

  /// Whether a good packet of this sender is used.
  /// @param now_ns time of arrival, robot clock
  bool admits(const SenderAddress& sender, std::int64_t now_ns) noexcept;
  [[nodiscard]] bool is_in_use(const SenderAddress& sender) const noexcept {
    return status_.in_use == sender;
  }
  [[nodiscard]] const SenderStatus& status() const noexcept { return status_; }

 private:
  [[nodiscard]] bool is_allowed(std::uint32_t ipv4) const noexcept;
  bool admit(const SenderAddress& sender, std::int64_t now_ns) noexcept;
  bool refuse(const SenderAddress& sender, std::int64_t now_ns) noexcept;
  [[nodiscard]] bool is_port_alive(std::int64_t now_ns) const noexcept;

  std::vector<std::uint32_t> allowed_;
  SenderStatus status_;
  std::int64_t heard_ns_ = 0;
  std::int64_t gap_ns_ = 0;  ///< longest time between two samples of the port in use, lately; 0: one sample
  std::uint16_t earlier_port_ = 0;  ///< of the same address; 0: none
  bool contested_ = false;          ///< two ports of one address send
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// UDP sockets of the drivers: lidar packets and sample datagrams come in through the receiver; simulator and
// player send through the sender.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace isobar {

/// One received datagram. The bytes live in the receiver until its next receive().
struct ReceivedDatagram {
  std::span<const std::uint8_t> payload;
  std::int64_t stamp_ns = 0;      ///< kernel's receive time on the robot clock (RobotClock)
  std::uint32_t sender_ipv4 = 0;  ///< address of the sender
  bool cut = false;               ///< the datagram was longer than the buffer
};

/// The robot clock of a live run: CLOCK_MONOTONIC plus the offset to the wall clock that held when the
/// process started. Its readings look like Unix time but never jump when the wall clock is set.
class RobotClock {
 public:
  static std::int64_t now_ns();
  /// Robot clock minus CLOCK_MONOTONIC, constant for the life of the process [ns].
  static std::int64_t offset_ns();
  /// Takes a wall-clock reading made a moment ago to the robot clock.
  static std::int64_t from_realtime_ns(std::int64_t realtime_ns);
};

/// Receives datagrams on one port, blocking, and can be stopped at once by another thread.
class UdpReceiver {
 public:
  /// address: IPv4 address to bind to, "0.0.0.0" for all. port 0: the kernel chooses, see port(). Throws
  /// ServiceError that names address and port when they cannot be bound.
  UdpReceiver(const std::string& address, std::uint16_t port);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  enum class Status : std::uint8_t { kDatagram, kTimeout, kStopped, kError };
  /// Waits for a datagram, at most timeout_ms (-1: for ever). Allocates nothing. One thread at a time.
  Status receive(ReceivedDatagram& datagram, int timeout_ms);
  /// Waits without looking at the socket: datagrams gather there. Ends early when stopped. Same thread as
  /// receive().
  void pause(int duration_ms) noexcept;
  /// Ends the wait of receive(), now and for all later calls. Any thread, signal handlers too.
  void stop() noexcept;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Datagrams that the kernel dropped because nobody fetched them in time (SO_RXQ_OVFL).
  [[nodiscard]] std::uint64_t dropped_by_kernel() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  int socket_ = -1;
  int stop_event_ = -1;
  std::uint16_t port_ = 0;
  std::uint32_t last_overflow_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
  std::vector<std::uint8_t> buffer_;
};

/// Sends datagrams to one address and port.
class UdpSender {
 public:
  /// Throws ServiceError that names address and port.
  UdpSender(const std::string& address, std::uint16_t port);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// False when the kernel refused; nobody listening is no error of UDP.
  bool send(std::span<const std::uint8_t> payload) noexcept;

 private:
  int socket_ = -1;
};

}  // namespace isobar

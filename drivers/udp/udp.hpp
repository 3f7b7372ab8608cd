// SPDX-License-Identifier: BSD-3-Clause
// UDP sockets: UdpReceiver takes lidar packets and sample datagrams, UdpSender serves simulator and player.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace isobar {

/// One received datagram. Its bytes belong to the receiver and stay valid until the next receive().
struct ReceivedDatagram {
  std::span<const std::uint8_t> payload;
  std::int64_t stamp_ns = 0;      ///< kernel's receive time, robot clock
  std::uint32_t sender_ipv4 = 0;  ///< address of the sender, host byte order
  bool cut = false;               ///< truncated: the datagram was longer than the buffer
};

/// Blocking receiver on one port; another thread can stop it at once.
class UdpReceiver {
 public:
  /// @param address IPv4 address to bind to, "0.0.0.0" for all interfaces
  /// @param port 0: the kernel chooses, see port()
  /// @throws ServiceError naming address and port when they cannot be bound
  UdpReceiver(const std::string& address, std::uint16_t port);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  enum class Status : std::uint8_t { kDatagram, kTimeout, kStopped, kError };
  /// Waits for a datagram, at most timeout_ms (-1: no limit). Allocates nothing. One thread at a time.
  Status receive(ReceivedDatagram& datagram, int timeout_ms);
  /// Sleeps while datagrams queue in the socket; stop() ends it early. Same thread as receive().
  void pause(int duration_ms) noexcept;
  /// Makes the current and all later receive() return kStopped. Any thread; async-signal-safe.
  void stop() noexcept;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Datagrams that the kernel dropped because the socket's buffer was full (SO_RXQ_OVFL).
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
  /// @throws ServiceError naming address and port when they cannot be sent to
  UdpSender(const std::string& address, std::uint16_t port);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// False when the kernel refused. UDP does not report a missing receiver.
  bool send(std::span<const std::uint8_t> payload) noexcept;

 private:
  int socket_ = -1;
};

}  // namespace isobar

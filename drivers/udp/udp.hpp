// SPDX-License-Identifier: BSD-3-Clause
// UDP sockets: UdpReceiver takes lidar packets and sample datagrams, UdpSender serves simulator and player.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/clock/receive_clock.hpp"

namespace isobar {

/// Address of a sender, host byte order.
struct SenderAddress {
  std::uint32_t ipv4 = 0;
  std::uint16_t port = 0;

  friend bool operator==(const SenderAddress&, const SenderAddress&) = default;
};

/// "192.168.1.201"
[[nodiscard]] std::string ipv4_text(std::uint32_t ipv4);
/// Host byte order; 0 for a text that is no dotted IPv4 address.
[[nodiscard]] std::uint32_t ipv4_of(const std::string& text);

/// One received datagram. Its bytes belong to the receiver and stay valid until the next receive().
struct ReceivedDatagram {
  std::span<const std::uint8_t> payload;
  std::int64_t stamp_ns = 0;  ///< kernel's receive time, robot clock
  SenderAddress sender;
  bool cut = false;     ///< truncated: the datagram was longer than the buffer
  bool second = false;  ///< came to the second port of a UdpPair
};

/// Blocking receiver on one port; another thread can stop it at once.
///
/// An address that no interface has yet and a port that another program holds are waited for: receive() tries
/// them again once a second. A socket whose address is taken from its interface receives again as soon as the
/// address is back.
class UdpReceiver {
 public:
  /// @param address IPv4 address to bind to, "0.0.0.0" for all interfaces
  /// @param port 0: the kernel chooses, see port()
  /// @param clocks readings of the clocks
  /// @throws ServiceError when the address is no IPv4 address, or this user may not use the port
  UdpReceiver(const std::string& address, std::uint16_t port, ClockSource clocks = &read_clocks);
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

  /// What this receiver waits for, in a sentence with the remedy; empty while it receives. Any thread.
  [[nodiscard]] std::string waiting_for() const;
  [[nodiscard]] std::uint16_t port() const { return port_.load(std::memory_order_relaxed); }
  /// Datagrams that the kernel dropped because the socket's buffer was full (SO_RXQ_OVFL).
  [[nodiscard]] std::uint64_t dropped_by_kernel() const { return dropped_.load(std::memory_order_relaxed); }
  /// Robot clock and system clock as this receiver sees them. Same thread as receive().
  [[nodiscard]] const ReceiveClock& clock() const { return clock_; }

 private:
  friend class UdpPair;
  /// @return 0, or the errno of the refusal
  int open() noexcept;
  void close_socket() noexcept;
  /// Opens the socket if that is due.
  /// @return timeout_ms, shortened to the next attempt while there is no socket; 0 after an attempt
  int prepare(int timeout_ms) noexcept;
  Status read(ReceivedDatagram& datagram) noexcept;

  std::string address_;
  std::uint16_t wanted_port_;
  int socket_ = -1;
  int stop_event_ = -1;
  std::atomic<int> refusal_{0};       ///< errno of the last attempt to open the socket; 0: it is open
  std::int64_t next_attempt_ns_ = 0;  ///< CLOCK_MONOTONIC
  std::atomic<std::uint16_t> port_;
  std::uint32_t last_overflow_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
  std::vector<std::uint8_t> buffer_;
  ReceiveClock clock_;
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

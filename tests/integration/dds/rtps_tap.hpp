// SPDX-License-Identifier: BSD-3-Clause
// Eavesdropper and forger on loopback: records DDS datagrams (RTPS) and sends datagrams. Needs root.
#pragma once

#include <arpa/inet.h>
#include <dds/dds.h>
#include <doctest/doctest.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace isobar::test {

using Bytes = std::vector<std::uint8_t>;

/// A datagram and its destination.
struct Datagram {
  std::uint32_t address = 0;  ///< IPv4, network byte order
  std::uint16_t port = 0;     ///< network byte order
  Bytes payload;
};

/// Records the datagrams of one DDS participant on loopback.
class RtpsTap {
 public:
  explicit RtpsTap(dds_entity_t participant) {
    dds_guid_t guid{};
    REQUIRE(dds_get_guid(participant, &guid) == DDS_RETCODE_OK);
    std::copy_n(guid.v, prefix_.size(), prefix_.begin());
    socket_ = ::socket(AF_PACKET, SOCK_DGRAM, htons(ETH_P_IP));
    sockaddr_ll place{};
    place.sll_family = AF_PACKET;
    place.sll_protocol = htons(ETH_P_IP);
    place.sll_ifindex = static_cast<int>(::if_nametoindex("lo"));
    REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0);
    const timeval limit{0, 100'000};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    thread_ = std::thread([this] { record(); });
  }
  ~RtpsTap() {
    stopped_ = true;
    thread_.join();
    ::close(socket_);
  }
  RtpsTap(const RtpsTap&) = delete;
  RtpsTap& operator=(const RtpsTap&) = delete;

  [[nodiscard]] std::vector<Datagram> recorded() {
    const std::lock_guard lock(mutex_);
    return datagrams_;
  }

 private:
  void record() {
    std::array<std::uint8_t, 65536> packet{};
    while (!stopped_) {
      sockaddr_ll from{};
      socklen_t size = sizeof from;
      const ssize_t count =
          ::recvfrom(socket_, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
      // Loopback shows each packet on its way out and in.
      if (count > 0 && from.sll_pkttype != PACKET_OUTGOING) take({packet.begin(), packet.begin() + count});
    }
  }
  /// @param packet from its IPv4 header on
  void take(const Bytes& packet) {
    constexpr std::size_t kUdpHeader = 8;
    constexpr std::size_t kRtpsHeader = 20;
    const std::size_t header = (packet[0] & 0x0FU) * 4U;
    if (packet.size() < header + kUdpHeader + kRtpsHeader || packet[9] != IPPROTO_UDP) return;
    const auto rtps = packet.begin() + static_cast<std::ptrdiff_t>(header + kUdpHeader);
    if (!std::equal(rtps, rtps + 4, "RTPS") || !std::equal(prefix_.begin(), prefix_.end(), rtps + 8)) return;
    Datagram datagram;
    std::memcpy(&datagram.address, &packet[16], 4);
    std::memcpy(&datagram.port, &packet[header + 2], 2);
    datagram.payload.assign(rtps, packet.end());
    const std::lock_guard lock(mutex_);
    datagrams_.push_back(std::move(datagram));
  }

  std::array<std::uint8_t, 12> prefix_{};
  int socket_ = -1;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::vector<Datagram> datagrams_;
  std::thread thread_;
};

/// Sends datagrams from a socket of its own.
class Forger {
 public:
  Forger() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const in_addr loopback{htonl(INADDR_LOOPBACK)};
    ::setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  }
  ~Forger() { ::close(socket_); }
  Forger(const Forger&) = delete;
  Forger& operator=(const Forger&) = delete;

  void send(const Datagram& datagram) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = datagram.address;
    to.sin_port = datagram.port;
    ::sendto(socket_, datagram.payload.data(), datagram.payload.size(), 0,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  /// Sends it to the unicast port of each of the first 12 participants of domain 0 on this machine: also to
  /// one that started after the recording.
  void send_to_all(Datagram datagram) const {
    constexpr std::uint16_t kFirstPort = 7411;
    datagram.address = htonl(INADDR_LOOPBACK);
    for (std::uint16_t i = 0; i < 12; ++i) {
      datagram.port = htons(static_cast<std::uint16_t>(kFirstPort + 2 * i));
      send(datagram);
    }
  }

 private:
  int socket_;
};

/// Submessages of RTPS 2.x (DDS Interoperability 9.4.5; DDS Security 7.3.6).
inline constexpr std::uint8_t kData = 0x15;
inline constexpr std::uint8_t kSecurePrefix = 0x31;
inline constexpr std::uint8_t kSecurePostfix = 0x32;

/// Calls `use(submessage)` for each submessage of a message, with its header; drops those for which it
/// returns false. Little-endian messages only, as this machine's are.
template <class Use>
Bytes edited(const Bytes& message, const Use& use) {
  constexpr std::size_t kHeader = 20;
  Bytes result(message.begin(), message.begin() + kHeader);
  for (std::size_t at = kHeader; at + 4 <= message.size();) {
    std::size_t length = static_cast<std::size_t>(message[at + 2]) | static_cast<std::size_t>(message[at + 3])
                                                                         << 8U;
    if (length == 0 || at + 4 + length > message.size()) length = message.size() - at - 4;
    Bytes submessage(message.begin() + static_cast<std::ptrdiff_t>(at),
                     message.begin() + static_cast<std::ptrdiff_t>(at + 4 + length));
    if (use(submessage)) result.insert(result.end(), submessage.begin(), submessage.end());
    at += 4 + length;
  }
  return result;
}

/// Whether a message holds a submessage of this kind.
inline bool has_submessage(const Bytes& message, std::uint8_t kind) {
  bool found = false;
  edited(message, [&](const Bytes& submessage) { return found = found || submessage[0] == kind; });
  return found;
}

/// Raises the sequence number of each sample in a message, as if newer ones were sent.
inline Bytes with_later_samples(const Bytes& message, std::uint8_t by) {
  constexpr std::size_t kSequenceLow = 20;
  return edited(message, [by](Bytes& submessage) {
    if (submessage[0] == kData && submessage.size() > kSequenceLow + 4) submessage[kSequenceLow + 1] += by;
    return true;
  });
}

/// Removes the signatures.
inline Bytes without_signatures(const Bytes& message) {
  return edited(message, [](const Bytes& submessage) {
    return submessage[0] != kSecurePrefix && submessage[0] != kSecurePostfix;
  });
}

}  // namespace isobar::test

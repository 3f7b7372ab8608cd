// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "run/recording/ports_seen.hpp"

namespace isobar::recording {

/// Headers in front of the IP packet. Values are libpcap's DLT_ numbers.
enum class LinkType : int {
  kLoopback = 0,  ///< 4 bytes of address family, in the byte order of the capturing machine
  kEthernet = 1,
  kRawIp = 12,
  kRawIpOpenBsd = 14,
  kRawIpFile = 101,    ///< as files number it
  kLoop = 108,         ///< 4 bytes of address family, big-endian
  kLinuxCooked = 113,  ///< capture on "any"
  kIpv4 = 228,
  kIpv6 = 229,  ///< holds no IPv4
  kLinuxCooked2 = 276,
};
[[nodiscard]] std::optional<LinkType> link_type_of(int data_link);
/// The known ones, for errors.
inline constexpr const char* kLinkTypesText =
    "Ethernet, Linux cooked (v1, v2), raw IP, IPv4 and loopback (NULL, LOOP)";

/// Destination ports of a lidar's packets.
struct LidarPorts {
  std::uint16_t data = 0;
  std::uint16_t info = 0;  ///< of its IMU, position or device information; 0: not wanted

  [[nodiscard]] bool has(std::uint16_t port) const { return port == data || (info != 0 && port == info); }
};

/// Content of a frame.
enum class FrameKind : std::uint8_t {
  kPayload,     ///< a UDP payload to a wanted port
  kCutPayload,  ///< the same, truncated by the capture
  kOtherPort,
  kOtherProtocol,  ///< ARP, TCP, IPv6, …
  kFragment,       ///< fragment of an incomplete datagram
  kMalformed,      ///< lengths contradict each other
};

/// Extractor of the UDP payloads for a lidar's ports from captured frames. Skips VLAN tags (802.1Q,
/// 802.1ad, stacked) and reassembles IPv4 fragments (RFC 791; the first byte wins where they overlap). A sender
/// counts the identifications of its datagrams in 16 bits, so that a lost fragment's is used again: fragments
/// that are kReassemblyNs apart are of two datagrams. Every length is checked before use.
class UdpExtractor {
 public:
  explicit UdpExtractor(const LidarPorts& ports) : ports_(ports) {}

  /// Longest time from a datagram's first fragment to its last; Linux's default (net.ipv4.ipfrag_time). An Ouster
  /// with a fragmented datagram every 1.4 ms comes back to an identification after 88 s.
  static constexpr std::int64_t kReassemblyNs = 30'000'000'000;

  /// @param stamp_ns time of the capture, for fragments
  /// @param payload valid until the next call; sender_ipv4() is the address that sent it
  FrameKind extract(LinkType link, std::span<const std::uint8_t> frame, std::int64_t stamp_ns,
                    std::span<const std::uint8_t>& payload);

  /// IPv4 source of the last frame with an IP packet, host byte order.
  [[nodiscard]] std::uint32_t sender_ipv4() const { return sender_ipv4_; }
  /// UDP destination of the last wanted payload.
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Incomplete datagrams that were dropped: kSlots newer ones needed the memory, or a later one has the same
  /// identification.
  [[nodiscard]] std::uint64_t incomplete() const { return incomplete_; }
  [[nodiscard]] std::uint64_t reassembled() const { return reassembled_; }
  /// Packets for other ports.
  [[nodiscard]] const PortsSeen& other_ports() const { return other_ports_; }
  [[nodiscard]] const LidarPorts& ports() const { return ports_; }

 private:
  static constexpr std::size_t kSlots = 4;
  static constexpr std::size_t kFragmentUnit = 8;
  static constexpr std::size_t kMaxDatagram = 65'536;

  struct Slot {
    bool used = false;
    std::uint64_t age = 0;
    std::int64_t stamp_ns = 0;           // of the first fragment that came
    std::array<std::uint8_t, 10> key{};  // identification, source, destination
    std::size_t length = 0;              // 0: the last fragment has not come
    std::vector<std::uint8_t> bytes;
    std::bitset<kMaxDatagram / kFragmentUnit> have;
  };

  FrameKind extract_ip(std::span<const std::uint8_t> ip, std::int64_t stamp_ns,
                       std::span<const std::uint8_t>& payload);
  FrameKind extract_udp(std::span<const std::uint8_t> udp, bool cut, std::span<const std::uint8_t>& payload);
  FrameKind add_fragment(std::span<const std::uint8_t> ip, std::span<const std::uint8_t> part,
                         std::int64_t stamp_ns, std::span<const std::uint8_t>& payload);
  Slot& slot_for(std::span<const std::uint8_t> ip, std::int64_t stamp_ns);

  LidarPorts ports_;
  PortsSeen other_ports_;
  std::uint32_t sender_ipv4_ = 0;
  std::uint16_t port_ = 0;
  std::uint64_t clock_ = 0;
  std::uint64_t incomplete_ = 0;
  std::uint64_t reassembled_ = 0;
  std::array<Slot, kSlots> slots_;
};

}  // namespace isobar::recording

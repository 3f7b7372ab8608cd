// SPDX-License-Identifier: BSD-3-Clause
// Ethernet II, IPv4 (RFC 791) and UDP (RFC 768) as far as a lidar's packets need them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isobar::recording {

inline constexpr std::size_t kEthernetHeaderBytes = 14;
inline constexpr std::size_t kIpv4HeaderBytes = 20;
inline constexpr std::size_t kUdpHeaderBytes = 8;
inline constexpr std::size_t kMaxUdpPayloadBytes = 65'535 - kIpv4HeaderBytes - kUdpHeaderBytes;

/// One's complement sum of RFC 1071 over big-endian 16-bit words; an odd last byte counts as the high half.
[[nodiscard]] std::uint32_t internet_sum(std::span<const std::uint8_t> bytes, std::uint32_t start = 0);
/// Folds and complements the sum.
[[nodiscard]] std::uint16_t internet_checksum(std::uint32_t sum);

/// A Velodyne's factory address, 192.168.1.201, in host byte order.
inline constexpr std::uint32_t kVelodyneIpv4 = 0xC0A8'01C9;

/// Builds the frame of a payload: to the broadcast address, equal source and destination port.
/// @param source_ipv4 host byte order
/// @param payload at most kMaxUdpPayloadBytes
/// @param frame overwritten
void build_udp_frame(std::span<const std::uint8_t> payload, std::uint16_t port, std::uint16_t identification,
                     std::vector<std::uint8_t>& frame, std::uint32_t source_ipv4 = kVelodyneIpv4);

/// Most bytes of an IP packet on Ethernet. A longer one travels in fragments (RFC 791).
inline constexpr std::size_t kEthernetMtu = 1'500;
/// Bytes that a fragment carries, of the IP packet behind its header; the last one carries the rest.
inline constexpr std::size_t kFragmentBytes = kEthernetMtu - kIpv4HeaderBytes;
static_assert(kFragmentBytes % 8 == 0);  // offsets count in 8 bytes

/// Builds one fragment of a frame that build_udp_frame() has built.
/// @param index below fragment_count(); a frame of one fragment is its own and is not built
/// @param fragment overwritten
void build_fragment(std::span<const std::uint8_t> frame, std::size_t index,
                    std::vector<std::uint8_t>& fragment);
/// Fragments that a frame travels in, 1 for one that fits into kEthernetMtu.
[[nodiscard]] constexpr std::size_t fragment_count(std::size_t frame_bytes) {
  return (frame_bytes - kEthernetHeaderBytes - kIpv4HeaderBytes + kFragmentBytes - 1) / kFragmentBytes;
}

}  // namespace isobar::recording

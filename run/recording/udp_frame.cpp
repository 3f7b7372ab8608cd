// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/udp_frame.hpp"

#include <algorithm>
#include <array>

namespace isobar::recording {
namespace {

constexpr std::array<std::uint8_t, 4> kDestinationAddress{255, 255, 255, 255};
constexpr std::array<std::uint8_t, 6> kSourceMac{0x60, 0x76, 0x88, 0x00, 0x00, 0x00};
constexpr std::uint8_t kUdpProtocol = 17;

void put_u16(std::uint8_t* at, std::size_t value) {
  at[0] = static_cast<std::uint8_t>(value >> 8U);
  at[1] = static_cast<std::uint8_t>(value);
}

}  // namespace

std::uint32_t internet_sum(std::span<const std::uint8_t> bytes, std::uint32_t start) {
  std::uint32_t sum = start;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    sum += static_cast<std::uint32_t>(bytes[i] << 8U) | bytes[i + 1];
  }
  if (bytes.size() % 2 != 0) {
    sum += static_cast<std::uint32_t>(bytes.back() << 8U);
  }
  return sum;
}

std::uint16_t internet_checksum(std::uint32_t sum) {
  while ((sum >> 16U) != 0) {
    sum = (sum & 0xFFFFU) + (sum >> 16U);
  }
  return static_cast<std::uint16_t>(~sum);
}

void build_udp_frame(std::span<const std::uint8_t> payload, std::uint16_t port, std::uint16_t identification,
                     std::vector<std::uint8_t>& frame, std::uint32_t source_ipv4) {
  const std::size_t udp_length = kUdpHeaderBytes + payload.size();
  frame.assign(kEthernetHeaderBytes + kIpv4HeaderBytes + udp_length, 0);

  std::uint8_t* ethernet = frame.data();
  std::fill_n(ethernet, 6, std::uint8_t{0xFF});
  std::copy(kSourceMac.begin(), kSourceMac.end(), ethernet + 6);
  put_u16(ethernet + 12, 0x0800);

  std::uint8_t* ip = ethernet + kEthernetHeaderBytes;
  ip[0] = 0x45;  // version 4, five words
  put_u16(ip + 2, kIpv4HeaderBytes + udp_length);
  put_u16(ip + 4, identification);
  ip[6] = 0x40;  // do not fragment
  ip[8] = 64;    // time to live
  ip[9] = kUdpProtocol;
  put_u16(ip + 12, source_ipv4 >> 16U);
  put_u16(ip + 14, source_ipv4 & 0xFFFFU);
  std::copy(kDestinationAddress.begin(), kDestinationAddress.end(), ip + 16);
  put_u16(ip + 10, internet_checksum(internet_sum({ip, kIpv4HeaderBytes})));

  std::uint8_t* udp = ip + kIpv4HeaderBytes;
  put_u16(udp, port);
  put_u16(udp + 2, port);
  put_u16(udp + 4, udp_length);
  std::copy(payload.begin(), payload.end(), udp + kUdpHeaderBytes);
  // The checksum covers a pseudo header of both addresses, the protocol and the length (RFC 768).
  const std::uint32_t pseudo =
      internet_sum({ip + 12, 8}, kUdpProtocol + static_cast<std::uint32_t>(udp_length));
  const std::uint16_t checksum = internet_checksum(internet_sum({udp, udp_length}, pseudo));
  put_u16(udp + 6, checksum == 0 ? 0xFFFF : checksum);  // 0 would mean "no checksum"
}

void build_fragment(std::span<const std::uint8_t> frame, std::size_t index,
                    std::vector<std::uint8_t>& fragment) {
  constexpr std::size_t kHeaders = kEthernetHeaderBytes + kIpv4HeaderBytes;
  constexpr std::size_t kMoreFragments = 0x2000;
  const auto content = frame.subspan(kHeaders);
  const std::size_t begin = index * kFragmentBytes;
  const std::size_t size = std::min(kFragmentBytes, content.size() - begin);
  const auto part = content.subspan(begin, size);
  fragment.assign(frame.begin(), frame.begin() + kHeaders);
  fragment.insert(fragment.end(), part.begin(), part.end());
  std::uint8_t* ip = fragment.data() + kEthernetHeaderBytes;
  put_u16(ip + 2, kIpv4HeaderBytes + size);
  put_u16(ip + 6, begin / 8 + (begin + size < content.size() ? kMoreFragments : 0));
  put_u16(ip + 10, 0);
  put_u16(ip + 10, internet_checksum(internet_sum({ip, kIpv4HeaderBytes})));
}

}  // namespace isobar::recording

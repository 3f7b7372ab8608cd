// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/udp_extractor.hpp"

#include <algorithm>

#include "run/recording/udp_frame.hpp"

namespace isobar::recording {
namespace {

constexpr std::uint16_t kTypeIpv4 = 0x0800;
constexpr std::uint8_t kProtocolUdp = 17;

std::uint16_t read_be16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

bool is_vlan(std::uint16_t type) { return type == 0x8100 || type == 0x88A8 || type == 0x9100; }

/// Removes the link header; an empty span when the frame is too short or not IPv4.
std::span<const std::uint8_t> ip_packet(LinkType link, std::span<const std::uint8_t> frame, bool& too_short) {
  std::size_t header = 0;
  std::size_t type_at = 0;
  switch (link) {
    case LinkType::kRawIp:
    case LinkType::kRawIpOpenBsd:
    case LinkType::kRawIpFile:
    case LinkType::kIpv4:
    case LinkType::kIpv6:
      return frame;
    case LinkType::kLoopback:
    case LinkType::kLoop:
      too_short = frame.size() < 4;
      return too_short ? frame.first(0) : frame.subspan(4);
    case LinkType::kEthernet:
      header = kEthernetHeaderBytes;
      type_at = 12;
      break;
    case LinkType::kLinuxCooked:
      header = 16;
      type_at = 14;
      break;
    case LinkType::kLinuxCooked2:
      header = 20;
      type_at = 0;
      break;
  }
  too_short = frame.size() < header;
  if (too_short) {
    return frame.first(0);
  }
  std::uint16_t type = read_be16(frame, type_at);
  while (is_vlan(type)) {
    too_short = frame.size() < header + 4;
    if (too_short) {
      return frame.first(0);
    }
    type = read_be16(frame, header + 2);
    header += 4;
  }
  return type == kTypeIpv4 ? frame.subspan(header) : frame.first(0);
}

}  // namespace

std::optional<LinkType> link_type_of(int data_link) {
  for (const LinkType link :
       {LinkType::kLoopback, LinkType::kEthernet, LinkType::kRawIp, LinkType::kRawIpOpenBsd,
        LinkType::kRawIpFile, LinkType::kLoop, LinkType::kLinuxCooked, LinkType::kIpv4, LinkType::kIpv6,
        LinkType::kLinuxCooked2}) {
    if (static_cast<int>(link) == data_link) {
      return link;
    }
  }
  return std::nullopt;
}

FrameKind UdpExtractor::extract(LinkType link, std::span<const std::uint8_t> frame, std::int64_t stamp_ns,
                                std::span<const std::uint8_t>& payload) {
  bool too_short = false;
  const auto ip = ip_packet(link, frame, too_short);
  if (too_short) {
    return FrameKind::kMalformed;
  }
  return ip.empty() ? FrameKind::kOtherProtocol : extract_ip(ip, stamp_ns, payload);
}

FrameKind UdpExtractor::extract_ip(std::span<const std::uint8_t> ip, std::int64_t stamp_ns,
                                   std::span<const std::uint8_t>& payload) {
  if (ip[0] >> 4U != 4) {
    return FrameKind::kOtherProtocol;
  }
  const std::size_t header = static_cast<std::size_t>(ip[0] & 0x0FU) * 4;
  if (header < kIpv4HeaderBytes || ip.size() < header) {
    return FrameKind::kMalformed;
  }
  if (ip[9] != kProtocolUdp) {
    return FrameKind::kOtherProtocol;
  }
  sender_ipv4_ = static_cast<std::uint32_t>(read_be16(ip, 12)) << 16U | read_be16(ip, 14);
  const std::size_t total = read_be16(ip, 2);
  if (total < header) {
    return FrameKind::kMalformed;
  }
  const bool cut = ip.size() < total;
  const auto part = ip.subspan(header, std::min(total, ip.size()) - header);
  const std::uint16_t fragment = read_be16(ip, 6);
  if ((fragment & 0x3FFFU) == 0) {  // no more fragments, offset 0: whole
    return extract_udp(part, cut, payload);
  }
  return cut ? FrameKind::kMalformed : add_fragment(ip, part, stamp_ns, payload);
}

FrameKind UdpExtractor::extract_udp(std::span<const std::uint8_t> udp, bool cut,
                                    std::span<const std::uint8_t>& payload) {
  if (udp.size() < kUdpHeaderBytes) {
    return FrameKind::kMalformed;
  }
  if (!ports_.has(read_be16(udp, 2))) {
    other_ports_.add(read_be16(udp, 2));
    return FrameKind::kOtherPort;
  }
  const std::size_t length = read_be16(udp, 4);
  if (length < kUdpHeaderBytes || (length > udp.size() && !cut)) {
    return FrameKind::kMalformed;
  }
  port_ = static_cast<std::uint16_t>(read_be16(udp, 2));
  payload = udp.subspan(kUdpHeaderBytes, std::min(length, udp.size()) - kUdpHeaderBytes);
  return cut ? FrameKind::kCutPayload : FrameKind::kPayload;
}

UdpExtractor::Slot& UdpExtractor::slot_for(std::span<const std::uint8_t> ip, std::int64_t stamp_ns) {
  std::array<std::uint8_t, 10> key{};
  std::copy_n(ip.begin() + 4, 2, key.begin());
  std::copy_n(ip.begin() + 12, 8, key.begin() + 2);
  Slot* chosen = &slots_[0];
  for (Slot& slot : slots_) {
    if (slot.used && slot.key == key) {
      const bool is_same =
          stamp_ns - slot.stamp_ns <= kReassemblyNs && slot.stamp_ns - stamp_ns <= kReassemblyNs;
      if (is_same) return slot;
      chosen = &slot;
      break;
    }
    if (!slot.used || (chosen->used && slot.age < chosen->age)) {
      chosen = chosen->used ? &slot : chosen;
    }
  }
  incomplete_ += chosen->used ? 1 : 0;
  chosen->used = true;
  chosen->age = ++clock_;
  chosen->stamp_ns = stamp_ns;
  chosen->key = key;
  chosen->length = 0;
  chosen->bytes.resize(kMaxDatagram);
  chosen->have.reset();
  return *chosen;
}

FrameKind UdpExtractor::add_fragment(std::span<const std::uint8_t> ip, std::span<const std::uint8_t> part,
                                     std::int64_t stamp_ns, std::span<const std::uint8_t>& payload) {
  const std::uint16_t field = read_be16(ip, 6);
  const bool more = (field & 0x2000U) != 0;
  const std::size_t offset = static_cast<std::size_t>(field & 0x1FFFU) * kFragmentUnit;
  const bool whole_units = part.size() % kFragmentUnit == 0;
  if (part.empty() || (more && !whole_units) || offset + part.size() > kMaxDatagram - 1) {
    return FrameKind::kMalformed;
  }
  Slot& slot = slot_for(ip, stamp_ns);
  for (std::size_t done = 0; done < part.size(); done += kFragmentUnit) {
    const std::size_t at = offset + done;
    if (!slot.have[at / kFragmentUnit]) {
      slot.have.set(at / kFragmentUnit);
      const auto unit = part.subspan(done, std::min(kFragmentUnit, part.size() - done));
      std::copy(unit.begin(), unit.end(), slot.bytes.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
  if (!more) {
    slot.length = offset + part.size();
  }
  const std::size_t units = (slot.length + kFragmentUnit - 1) / kFragmentUnit;
  if (slot.length == 0 || slot.have.count() != units) {
    return FrameKind::kFragment;
  }
  slot.used = false;
  ++reassembled_;
  return extract_udp({slot.bytes.data(), slot.length}, false, payload);
}

}  // namespace isobar::recording

// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pcap_packets.hpp"

#include <utility>

#include "core/errors.hpp"
#include "core/plausibility.hpp"

namespace isobar::recording {

PcapPackets::PcapPackets(const std::filesystem::path& file, const LidarPorts& ports,
                         const StampGuardConfig& guard)
    : name_(file.string()), file_(open_capture(file)), extractor_(ports), guard_(guard) {
  if (file_->data_link() >= 0) refuse_link();
}

void PcapPackets::refuse_link() const {
  const auto link = link_type_of(file_->data_link());
  if (!link) {
    throw DataError(name_ + ": holds frames of link type " + data_link_name(file_->data_link()) +
                    "; known are " + kLinkTypesText);
  }
  if (*link == LinkType::kIpv6) {
    throw DataError(name_ + ": holds frames of link type IPV6 only; a lidar's packets are IPv4");
  }
}

std::string PcapPackets::place() const { return name_ + ": frame " + std::to_string(frames_) + ": "; }

std::string PcapPackets::ports_text(const std::string& who) const {
  const PortsSeen& seen = extractor_.other_ports();
  if (seen.empty()) return {};
  const LidarPorts& ports = extractor_.ports();
  return name_ + ": " + seen.text() + ", " + who + " says " + std::to_string(ports.data) +
         (ports.info == 0 ? "" : " and " + std::to_string(ports.info));
}

bool PcapPackets::read(StampedPacket& packet) {
  CaptureFrame frame;
  while (!ended_) {
    if (!file_->next(frame)) {
      ended_ = true;
      if (!file_->damage().empty()) {
        tallies_.file_truncated.add(
            [this] { return place() + "the file ends early or is broken: " + file_->damage(); });
      }
      break;
    }
    ++frames_;
    if (take(frame, packet)) return true;
  }
  return false;
}

/// False for a frame without a wanted payload.
bool PcapPackets::take(const CaptureFrame& frame, StampedPacket& packet) {
  const auto link = link_type_of(frame.data_link);
  if (!link) {
    tallies_.other_link.add([&] {
      return place() + "is of link type " + data_link_name(frame.data_link) + "; known are " + kLinkTypesText;
    });
    return false;
  }
  std::span<const std::uint8_t> payload;
  switch (extractor_.extract(*link, frame.bytes, frame.stamp_ns, payload)) {
    case FrameKind::kOtherPort:
      tallies_.other_port.add([this] { return place() + "is for another UDP port"; });
      return false;
    case FrameKind::kOtherProtocol:
      tallies_.other_protocol.add([this] { return place() + "is no UDP over IPv4"; });
      return false;
    case FrameKind::kMalformed:
      tallies_.malformed.add([this] { return place() + "the lengths in its headers contradict each other"; });
      return false;
    case FrameKind::kFragment:
      return false;
    case FrameKind::kCutPayload:
      tallies_.cut.add([this] { return place() + "the capture holds only its beginning"; });
      break;
    case FrameKind::kPayload:
      break;
  }
  packet.stamp_ns = frame.stamp_ns;
  packet.sender_ipv4 = extractor_.sender_ipv4();
  packet.port = extractor_.port();
  packet.payload.assign(payload.begin(), payload.end());
  return true;
}

bool PcapPackets::next(StampedPacket& packet) {
  if (following_) {
    std::swap(packet, *following_);
    following_.reset();
    return true;
  }
  for (;;) {
    const std::int64_t newest_ns = guard_.newest_ns();
    const bool more = read(packet);
    if (!more && !held_) {
      return false;
    }
    const bool implausible = more && implausible_stamp(packet.stamp_ns) != nullptr;
    if (implausible) {
      packet.stamp_ns = newest_ns;
      tallies_.absurd_stamp.add([this] { return place() + "its time stamp is impossible"; });
    }
    const StampVerdict verdict = more && !implausible ? guard_.check(packet.stamp_ns) : StampVerdict::kAccept;
    if (held_ && verdict != StampVerdict::kConfirmed) {
      held_->stamp_ns = newest_ns;
      tallies_.absurd_stamp.add([this] { return place() + "the time stamp before it was absurd"; });
    }
    if (verdict == StampVerdict::kHeld) {
      std::optional<StampedPacket> previous = std::move(held_);
      held_ = std::move(packet);
      if (previous) {
        packet = std::move(*previous);
        return true;
      }
      continue;
    }
    if (held_) {
      following_ = more ? std::optional<StampedPacket>(std::move(packet)) : std::nullopt;
      packet = std::move(*held_);
      held_.reset();
    }
    return true;
  }
}

}  // namespace isobar::recording

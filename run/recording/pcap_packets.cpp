// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pcap_packets.hpp"

#include <pcap/pcap.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/errors.hpp"
#include "core/plausibility.hpp"

namespace isobar::recording {
namespace {

// Size of the file buffer: 200 packets per read() instead of three.
constexpr std::size_t kBufferBytes = std::size_t{256} * 1024;

}  // namespace

PcapPackets::PcapPackets(const std::filesystem::path& file, const LidarPorts& ports,
                         const StampGuardConfig& guard)
    : name_(file.string()), buffer_(kBufferBytes), extractor_(ports), guard_(guard) {
  if (!std::filesystem::exists(file)) {
    throw DataError(name_ + ": no such file");
  }
  if (std::filesystem::is_directory(file)) {
    throw DataError(name_ + ": is a folder, must be a file");
  }
  std::FILE* stream = std::fopen(name_.c_str(), "rb");
  if (stream == nullptr) {
    throw DataError(name_ + ": cannot be read: " + std::strerror(errno));
  }
  std::setvbuf(stream, buffer_.data(), _IOFBF, buffer_.size());
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  handle_ = pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data());
  if (handle_ == nullptr) {
    std::fclose(stream);
    throw DataError(name_ + ": is no pcap file: " + error.data());
  }
  const auto link = link_type_of(pcap_datalink(handle_));
  if (!link) {
    const char* link_name = pcap_datalink_val_to_name(pcap_datalink(handle_));
    const std::string text = link_name == nullptr ? "unknown" : link_name;
    pcap_close(handle_);
    throw DataError(name_ + ": holds frames of link type " + text +
                    "; known are Ethernet, Linux cooked, raw IP and loopback");
  }
  link_ = *link;
}

PcapPackets::~PcapPackets() { pcap_close(handle_); }

std::string PcapPackets::place() const { return name_ + ": frame " + std::to_string(frames_) + ": "; }

std::uint64_t PcapPackets::bytes_read() const {
  const long position = std::ftell(pcap_file(handle_));
  return position < 0 ? 0 : static_cast<std::uint64_t>(position);
}

bool PcapPackets::read(StampedPacket& packet) {
  while (!ended_) {
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    const int status = pcap_next_ex(handle_, &header, &data);
    if (status != 1) {
      ended_ = true;
      if (status == PCAP_ERROR) {
        tallies_.file_truncated.add(
            [this] { return place() + "the file ends early or is broken: " + pcap_geterr(handle_); });
      }
      break;
    }
    ++frames_;
    std::span<const std::uint8_t> payload;
    const std::int64_t stamp_ns =
        static_cast<std::int64_t>(header->ts.tv_sec) * 1'000'000'000 + header->ts.tv_usec;
    const FrameKind kind = extractor_.extract(link_, {data, header->caplen}, stamp_ns, payload);
    switch (kind) {
      case FrameKind::kOtherPort:
        tallies_.other_port.add([this] { return place() + "is for another UDP port"; });
        continue;
      case FrameKind::kOtherProtocol:
        tallies_.other_protocol.add([this] { return place() + "is no UDP over IPv4"; });
        continue;
      case FrameKind::kMalformed:
        tallies_.malformed.add(
            [this] { return place() + "the lengths in its headers contradict each other"; });
        continue;
      case FrameKind::kFragment:
        continue;
      case FrameKind::kCutPayload:
        tallies_.cut.add([this] { return place() + "the capture holds only its beginning"; });
        break;
      case FrameKind::kPayload:
        break;
    }
    packet.stamp_ns = stamp_ns;
    packet.sender_ipv4 = extractor_.sender_ipv4();
    packet.payload.assign(payload.begin(), payload.end());
    return true;
  }
  return false;
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

// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pcapng_file.hpp"

#include <algorithm>
#include <array>

namespace isobar::recording {
namespace {

// Types of blocks.
constexpr std::uint32_t kSectionHeader = 0x0A0D'0D0A;
constexpr std::uint32_t kInterfaceDescription = 1;
constexpr std::uint32_t kObsoletePacket = 2;
constexpr std::uint32_t kSimplePacket = 3;
constexpr std::uint32_t kEnhancedPacket = 6;

constexpr std::uint32_t kByteOrderMagic = 0x1A2B'3C4D;
constexpr std::size_t kBlockFrameBytes = 12;                          // type and both lengths
constexpr std::size_t kLongestBlock = std::size_t{16} * 1024 * 1024;  // as libpcap
constexpr std::size_t kMostInterfaces = 4096;
// Options of an interface.
constexpr std::uint32_t kOptionResolution = 9;
constexpr std::uint32_t kOptionOffset = 14;
// LINKTYPE_ numbers of files that differ from the DLT_ numbers of libpcap on Linux.
constexpr int kLinkTypeRaw = 101;
constexpr int kDataLinkRaw = 12;

constexpr std::uint64_t kMostSeconds = 9'000'000'000;  // int64 nanoseconds hold them

}  // namespace

bool is_pcapng(std::string_view head) { return head == "\x0A\x0D\x0D\x0A"; }

bool PcapngFile::fail(const std::string& reason) {
  damage_ = file_->damage().empty() ? reason : file_->damage();
  ended_ = true;
  return false;
}

std::uint32_t PcapngFile::u16(std::size_t at) const {
  const std::uint32_t first = body_[at];
  const std::uint32_t second = body_[at + 1];
  return big_endian_ ? first << 8U | second : first | second << 8U;
}

std::uint32_t PcapngFile::u32_of(const std::uint8_t* at) const {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8U | at[big_endian_ ? k : 3 - k];
  }
  return value;
}

/// @param may_end the file may end before the first byte
bool PcapngFile::read_exactly(std::uint8_t* to, std::size_t size, bool may_end) {
  std::size_t have = 0;
  while (have < size) {
    const std::size_t count = file_->read(reinterpret_cast<char*>(to) + have, size - have);
    if (count == 0 && have == 0 && may_end && file_->damage().empty()) {
      ended_ = true;
      return false;
    }
    if (count == 0) return fail("the file ends within a block");
    have += count;
  }
  return true;
}

bool PcapngFile::read_block(std::uint32_t& type) {
  std::array<std::uint8_t, 12> start{};
  if (!read_exactly(start.data(), 8, true)) return false;
  type = u32_of(start.data());
  std::size_t read_already = 8;
  if (type == kSectionHeader) {
    if (!read_exactly(start.data() + 8, 4, false)) return false;
    read_already = 12;
    big_endian_ = false;
    if (u32_of(start.data() + 8) != kByteOrderMagic) big_endian_ = true;
    if (u32_of(start.data() + 8) != kByteOrderMagic) return fail("a section has no byte-order magic");
  }
  const std::size_t length = u32_of(start.data() + 4);
  if (length < std::max(kBlockFrameBytes, read_already + 4) || length % 4 != 0 || length > kLongestBlock) {
    return fail("a block has the length " + std::to_string(length));
  }
  body_.resize(length - kBlockFrameBytes);
  std::copy(start.begin() + 8, start.begin() + static_cast<std::ptrdiff_t>(read_already), body_.begin());
  std::array<std::uint8_t, 4> end{};
  if (!read_exactly(body_.data() + (read_already - 8), length - 4 - read_already, false) ||
      !read_exactly(end.data(), end.size(), false)) {
    return false;
  }
  if (u32_of(end.data()) != length) return fail("the two lengths of a block differ");
  return true;
}

bool PcapngFile::next(CaptureFrame& frame) {
  std::uint32_t type = 0;
  while (!ended_ && read_block(type)) {
    bool has_frame = false;
    switch (type) {
      case kSectionHeader:
        interfaces_.clear();
        break;
      case kInterfaceDescription:
        if (!add_interface()) return false;
        break;
      case kEnhancedPacket:
        has_frame = take_enhanced(frame);
        break;
      case kSimplePacket:
        has_frame = take_simple(frame);
        break;
      case kObsoletePacket:
        has_frame = take_obsolete(frame);
        break;
      default:
        break;
    }
    if (has_frame) return true;
  }
  return false;
}

bool PcapngFile::add_interface() {
  if (body_.size() < 8 || interfaces_.size() >= kMostInterfaces) {
    return fail(body_.size() < 8 ? "the description of an interface is too short" : "too many interfaces");
  }
  Interface interface;
  interface.data_link = static_cast<int>(u16(0));
  if (interface.data_link == kLinkTypeRaw) interface.data_link = kDataLinkRaw;
  read_options(8, interface);
  interfaces_.push_back(interface);
  return interface.units_per_s != 0 || fail("an interface has a resolution of time that is not supported");
}

void PcapngFile::read_options(std::size_t at, Interface& interface) const {
  while (at + 4 <= body_.size()) {
    const std::uint32_t code = u16(at);
    const std::size_t length = u16(at + 2);
    at += 4;
    if (code == 0 || length > body_.size() - at) return;
    if (code == kOptionResolution && length == 1) {
      constexpr unsigned kMostDigits = 19;
      const unsigned exponent = body_[at] & 0x7FU;
      const bool binary = (body_[at] & 0x80U) != 0;
      interface.units_per_s = binary && exponent < 64 ? std::uint64_t{1} << exponent : 0;
      if (!binary && exponent <= kMostDigits) {
        interface.units_per_s = 1;
        for (unsigned k = 0; k < exponent; ++k) interface.units_per_s *= 10;
      }
    }
    if (code == kOptionOffset && length == 8) {
      const std::uint64_t low = u32(big_endian_ ? at + 4 : at);
      const std::uint64_t high = u32(big_endian_ ? at : at + 4);
      interface.offset_s = static_cast<std::int64_t>(high << 32U | low);
    }
    at += (length + 3) / 4 * 4;
  }
}

/// Time of a packet: two words, the high one first in either byte order.
std::int64_t PcapngFile::stamp_ns(std::size_t interface, std::size_t at) const {
  const Interface& from = interfaces_[interface];
  const std::uint64_t units = static_cast<std::uint64_t>(u32(at)) << 32U | u32(at + 4);
  const std::uint64_t seconds = units / from.units_per_s;
  const std::uint64_t rest = units % from.units_per_s;
  const auto limit = static_cast<std::int64_t>(kMostSeconds);
  if (seconds > kMostSeconds || from.offset_s > limit || from.offset_s < -limit) return kNoCaptureStamp;
  const std::int64_t total_s = static_cast<std::int64_t>(seconds) + from.offset_s;
  if (total_s < 0 || total_s > limit) return kNoCaptureStamp;
  // Exact up to nanoseconds; finer resolutions lose only what nanoseconds cannot hold.
  constexpr std::uint64_t kNsOfSecond = 1'000'000'000;
  const std::uint64_t ns = from.units_per_s <= kNsOfSecond
                               ? rest * kNsOfSecond / from.units_per_s
                               : static_cast<std::uint64_t>(static_cast<double>(rest) * 1e9 /
                                                            static_cast<double>(from.units_per_s));
  return total_s * static_cast<std::int64_t>(kNsOfSecond) + static_cast<std::int64_t>(ns);
}

bool PcapngFile::give(std::size_t interface, std::int64_t stamp, std::size_t at, std::size_t size,
                      CaptureFrame& frame) {
  if (size > body_.size() - at) return fail("a packet is longer than its block");
  frame.stamp_ns = stamp;
  frame.data_link = interfaces_[interface].data_link;
  frame.bytes = std::span<const std::uint8_t>(body_).subspan(at, size);
  return true;
}

bool PcapngFile::take_enhanced(CaptureFrame& frame) {
  constexpr std::size_t kHeader = 20;
  if (body_.size() < kHeader) return fail("a packet's block is too short");
  const std::size_t interface = u32(0);
  if (interface >= interfaces_.size()) return fail("a packet names an interface that is not described");
  return give(interface, stamp_ns(interface, 4), kHeader, u32(12), frame);
}

bool PcapngFile::take_simple(CaptureFrame& frame) {
  constexpr std::size_t kHeader = 4;
  if (body_.size() < kHeader) return fail("a packet's block is too short");
  if (interfaces_.empty()) return fail("a packet names an interface that is not described");
  // Its captured length is not written: the smaller one of the length on the wire and what the block holds.
  return give(0, kNoCaptureStamp, kHeader, std::min<std::size_t>(u32(0), body_.size() - kHeader), frame);
}

bool PcapngFile::take_obsolete(CaptureFrame& frame) {
  constexpr std::size_t kHeader = 20;
  if (body_.size() < kHeader) return fail("a packet's block is too short");
  const std::size_t interface = u16(0);
  if (interface >= interfaces_.size()) return fail("a packet names an interface that is not described");
  return give(interface, stamp_ns(interface, 4), kHeader, u32(12), frame);
}

}  // namespace isobar::recording

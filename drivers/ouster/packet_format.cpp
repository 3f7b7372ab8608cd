// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/packet_format.hpp"

namespace isobar::ouster {
namespace {

std::uint32_t le24(const std::uint8_t* at) { return le16(at) | static_cast<std::uint32_t>(at[2]) << 16U; }
std::uint64_t le40(const std::uint8_t* at) { return le32(at) | static_cast<std::uint64_t>(at[4]) << 32U; }

}  // namespace

std::string profile_names() {
  std::string text;
  for (const Profile& profile : kProfiles) {
    const bool is_last = &profile == &kProfiles.back();
    text += (text.empty() ? "" : is_last ? " and " : ", ") + std::string(profile.name);
  }
  return text;
}

PacketHeader PacketLayout::header(const std::uint8_t* packet) const {
  if (!profile_->has_header) return {};
  if (has_safety_header_) return {packet[0], le24(packet + 1), le40(packet + 11)};
  return {le16(packet), le24(packet + 4), le40(packet + 7)};
}

std::string formats_of_size(std::size_t bytes) {
  std::string text;
  for (const int pixels : {16, 32, 64, 128, 256}) {
    std::string names;
    for (const Profile& profile : kProfiles) {
      if (PacketLayout(profile, pixels, 16, false).packet_bytes() != bytes) continue;
      names += (names.empty() ? "" : "/") + std::string(profile.name);
    }
    if (names.empty()) continue;
    text += (text.empty() ? "" : ", or ") + std::to_string(pixels) + " beams in " + names;
  }
  return text;
}

}  // namespace isobar::ouster

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/velodyne/model_evidence.hpp"

#include <algorithm>

namespace isobar::velodyne {
namespace {

/// Pairs for a verdict: half of those in one packet.
constexpr std::uint32_t kLeastPairs = 96;
/// Pairs after which older ones are halved.
constexpr std::uint32_t kMostPairs = 4'096;
/// Gaps between packets for a verdict.
constexpr std::uint32_t kLeastGaps = 16;
/// Pace of a VLP-16 in single return, 1327 us, within 5 %.
constexpr std::uint32_t kSlowestUs = 1'393;
constexpr std::uint32_t kFastestUs = 1'261;

/// Ranges that differ by less than 1 %, or by noise: 3 cm.
bool is_near(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t apart = a > b ? a - b : b - a;
  return apart <= std::max<std::uint32_t>(a / 100, 15);
}

}  // namespace

void ModelEvidence::add(const DataPacket& packet) {
  add_pattern(packet);
  add_pace(packet);
  const bool pattern =
      pairs_ >= kLeastPairs && 10 * same_beam_ > 6 * pairs_ && 10 * other_beam_ < 7 * same_beam_;
  const bool pace = gaps_ >= kLeastGaps && shortest_us_ >= kFastestUs && shortest_us_ <= kSlowestUs;
  sixteen_ = pattern || pace;
}

void ModelEvidence::add_pattern(const DataPacket& packet) {
  for (int block = 0; block < kBlocks; ++block) {
    const std::uint8_t* channels = packet.channels(block);
    for (std::size_t c = 0; c < 16; ++c) {
      const std::uint32_t here = le16(channels + c * kChannelBytes);
      const std::uint32_t same = le16(channels + (c + 16) * kChannelBytes);
      const std::uint32_t other = le16(channels + (c + 15) * kChannelBytes);
      if (here == 0 || same == 0 || other == 0) continue;
      ++pairs_;
      same_beam_ += is_near(here, same) ? 1 : 0;
      other_beam_ += is_near(here, other) ? 1 : 0;
    }
  }
  if (pairs_ > kMostPairs) {
    pairs_ /= 2;
    same_beam_ /= 2;
    other_beam_ /= 2;
  }
}

void ModelEvidence::add_pace(const DataPacket& packet) {
  const std::uint32_t gap_us = packet.timestamp_us - last_us_;
  if (started_ && gap_us > 0 && gap_us < 1'000'000 && !packet.dual) {
    shortest_us_ = gaps_ == 0 ? gap_us : std::min(shortest_us_, gap_us);
    ++gaps_;
  }
  started_ = true;
  last_us_ = packet.timestamp_us;
}

}  // namespace isobar::velodyne

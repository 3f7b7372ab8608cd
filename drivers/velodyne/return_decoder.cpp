// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/velodyne/return_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar::velodyne {
namespace {

constexpr double kRadPerCount = kRadPerDeg / 100.0;
/// Larger azimuth steps between blocks are gaps of a restricted field of view, not rotation [0.01 deg]: 10
/// deg in one block would be 250 turns a second.
constexpr std::uint32_t kMaxBlockStep = 1'000;
/// Fixed-point unit of Channel::turn_share. Shares are rounded up, so that halves of a count round up; the
/// error of 0.001 counts is below the 1/48 count that separates any channel's rotation from a different
/// rounding.
constexpr std::uint32_t kWholeShare = 1U << 20U;

std::uint32_t to_count(double degrees) {
  const double turns = degrees / 360.0;
  return static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * kFullTurn)) % kFullTurn;
}

/// azimuth mod kFullTurn for azimuths below two turns, without a division: one for each return would double
/// the decoder's cost.
std::uint32_t within_turn(std::uint32_t azimuth) {
  return azimuth >= kFullTurn ? azimuth - kFullTurn : azimuth;
}

}  // namespace

ReturnDecoder::ReturnDecoder(const VelodyneConfig& config)
    : traits_(traits_of(config.model)), directions_(kFullTurn) {
  const std::int64_t block_ns = traits_.firings_per_block * traits_.firing_cycle_ns;
  for (int i = 0; i < kChannels; ++i) {
    const auto laser = static_cast<std::size_t>(i % traits_.lasers);
    const double elevation_rad = traits_.elevation_deg[laser] * kRadPerDeg;
    const std::int64_t firing_ns = traits_.firing_offset_ns(0, i, false);
    const std::int64_t share = (firing_ns * kWholeShare + block_ns - 1) / block_ns;
    channels_[static_cast<std::size_t>(i)] = {
        static_cast<float>(std::cos(elevation_rad)), static_cast<float>(std::sin(elevation_rad)),
        static_cast<std::uint32_t>(firing_ns), static_cast<std::uint32_t>(share), traits_.ring[laser]};
  }
  for (std::size_t count = 0; count < kFullTurn; ++count) {
    const double azimuth_rad = static_cast<double>(count) * kRadPerCount;
    directions_[count] = {static_cast<float>(std::cos(azimuth_rad)),
                          -static_cast<float>(std::sin(azimuth_rad))};
  }
  set_limits(config);
}

void ReturnDecoder::set_limits(const VelodyneConfig& config) {
  constexpr double kMaxCount = 65'535.0;
  // 1e-6 absorbs rounding: 0.3 m / 2 mm is 150.00000000000003.
  min_count_ = static_cast<std::uint32_t>(
      std::clamp(std::ceil(config.min_range_m / kDistanceUnitM - 1e-6), 1.0, kMaxCount));
  max_count_ = static_cast<std::uint32_t>(
      std::clamp(std::floor(config.max_range_m / kDistanceUnitM + 1e-6), 0.0, kMaxCount));
  mask_start_ = to_count(config.mask_start_deg);
  mask_width_ = within_turn(to_count(config.mask_end_deg) + kFullTurn - mask_start_);
}

std::uint32_t ReturnDecoder::decode(const DataPacket& packet, int first_block, int end_block,
                                    std::int64_t since_start_ns, ScanPoint* out) const {
  const int stride = packet.dual ? 2 : 1;
  std::uint32_t written = 0;
  std::uint32_t step = 0;
  for (int block = 0; block < end_block; ++block) {
    const std::uint32_t azimuth = packet.azimuth[static_cast<std::size_t>(block)];
    const int next = block / stride * stride + stride;
    if (next < kBlocks) {  // the last firing reuses the step of the one before
      const std::uint32_t to_next =
          within_turn(packet.azimuth[static_cast<std::size_t>(next)] + kFullTurn - azimuth);
      step = to_next <= kMaxBlockStep ? to_next : step;
    }
    if (block >= first_block) {
      // Dual return: an odd block holds the other return of the firing in the even block before it.
      const bool second = packet.dual && block % 2 == 1;
      const std::int64_t start_ns = since_start_ns + traits_.firing_offset_ns(block, 0, packet.dual);
      written += decode_block({packet.channels(block), second ? packet.channels(block - 1) : nullptr, azimuth,
                               step, static_cast<std::uint32_t>(start_ns)},
                              out + written);
    }
  }
  return written;
}

std::uint32_t ReturnDecoder::decode_block(const Block& block, ScanPoint* out) const {
  constexpr auto kTimeUnitNs = static_cast<std::uint32_t>(kPointTimeUnitNs);
  std::uint32_t written = 0;
  std::size_t at = 0;
  for (const Channel& channel : channels_) {
    const std::uint32_t count = read_u16(block.channels + at);
    const bool repeated = block.other_return != nullptr && read_u16(block.other_return + at) == count;
    // Rounded to the resolution of the packet's azimuth: error at most 0.005 deg, 0.9 mm at 10 m.
    const std::uint32_t beyond = (block.step * channel.turn_share + kWholeShare / 2) / kWholeShare;
    const std::uint32_t azimuth = within_turn(block.azimuth + beyond);
    const bool masked = within_turn(azimuth + kFullTurn - mask_start_) < mask_width_;
    const float range_m = static_cast<float>(count) * static_cast<float>(kDistanceUnitM);
    const float across_m = range_m * channel.cos_elevation;
    const Direction& direction = directions_[azimuth];
    const std::uint32_t time_ns = block.start_ns + channel.firing_ns;
    // Branch-free: written always, overwritten by the next point when dropped. A branch would mispredict.
    out[written] = {across_m * direction.x,
                    across_m * direction.y,
                    range_m * channel.sin_elevation,
                    static_cast<std::uint16_t>((time_ns + kTimeUnitNs / 2) / kTimeUnitNs),
                    channel.ring,
                    block.channels[at + 2]};
    const bool in_range = count >= min_count_ && count <= max_count_;
    written += in_range && !masked && !repeated ? 1 : 0;
    at += kChannelBytes;
  }
  return written;
}

}  // namespace isobar::velodyne

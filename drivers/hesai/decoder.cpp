// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/hesai/decoder.hpp"

#include <cmath>

#include "core/geometry.hpp"
#include "drivers/lidar/civil_time.hpp"

namespace isobar::hesai {
namespace {

enum class ReturnMode : std::uint8_t {
  kFirst = 0x33,
  kStrongest = 0x37,
  kLast = 0x38,
  kLastStrongest = 0x39,
  kLastFirst = 0x3B,
  kFirstStrongest = 0x3C,
};

/// Returns of a firing; 0 for a byte that is no return mode.
int returns_of(std::uint8_t mode) {
  switch (static_cast<ReturnMode>(mode)) {
    case ReturnMode::kFirst:
    case ReturnMode::kStrongest:
    case ReturnMode::kLast:
      return 1;
    case ReturnMode::kLastStrongest:
    case ReturnMode::kLastFirst:
    case ReturnMode::kFirstStrongest:
      return 2;
  }
  return 0;
}

CivilTime time_of(const std::uint8_t* tail) {
  const std::uint8_t* date = tail + kDateOffset;
  return {1900 + date[0],
          date[1],
          date[2],
          date[3],
          date[4],
          date[5],
          static_cast<std::int64_t>(le32(tail + kMicrosecondOffset)) * 1'000};
}

bool has_magic(std::span<const std::uint8_t> payload) {
  return payload.size() >= kHeaderBytes && payload[0] == 0xEE && payload[1] == 0xFF;
}

AngleTable nominal_angles(const ModelTraits& traits) {
  AngleTable table;
  for (int i = 0; i < traits.lasers; ++i) {
    table.elevation_deg.push_back(traits.highest_deg - i * traits.elevation_step_deg);
    table.azimuth_deg.push_back(0.0);
  }
  return table;
}

}  // namespace

Decoder::Decoder(const ModelTraits& traits, const LidarLimits& limits, const AngleTable& angles)
    : traits_(traits), directions_(turn_directions()) {
  const AngleTable table = angles.channels() == 0 ? nominal_angles(traits) : angles;
  const std::vector<std::uint8_t> rings = table.rings();
  for (std::size_t i = 0; i < table.channels(); ++i) {
    const double elevation_rad = table.elevation_deg[i] * kRadPerDeg;
    const double ahead_rad = table.azimuth_deg[i] * kRadPerDeg;
    beams_.push_back({static_cast<float>(std::cos(elevation_rad)),
                      static_cast<float>(std::sin(elevation_rad)), static_cast<float>(std::cos(ahead_rad)),
                      static_cast<float>(std::sin(ahead_rad)), turn_count(table.azimuth_deg[i]),
                      static_cast<std::int64_t>(i) * traits.firing_step_ns, rings[i]});
  }
  set_limits(limits);
}

void Decoder::set_limits(const LidarLimits& limits) {
  constexpr std::uint32_t kMaxCount = 65'535;
  limits_m_ = limits;
  limits_ = CountLimits(limits, unit_m_, kMaxCount);
}

DecodeStatus Decoder::read(std::span<const std::uint8_t> payload, PacketColumns& packet) {
  const DecodeStatus status = check(payload);
  if (status == DecodeStatus::kWrongModel) {
    mismatch_ = "packets of a Hesai with " + std::to_string(payload[kLasersOffset]) + " lasers, protocol " +
                std::to_string(payload[2]) + "." + std::to_string(payload[3]) + ", but " +
                std::string(traits_.name) + " is configured";
  }
  if (status != DecodeStatus::kOk) return status;
  if (const double unit_m = payload[kUnitOffset] * 1e-3; unit_m != unit_m_) {
    unit_m_ = unit_m;
    set_limits(limits_m_);
  }
  const std::uint8_t* tail = payload.data() + traits_.packet_bytes() - kTailBytes;
  const int returns = returns_of(tail[kReturnModeOffset]);
  const int firings = kBlocks / returns;
  packet.device_ns = time_of(tail).since_epoch_ns() + kLastBlockNs + kFirstLaserNs - (firings - 1) * kBlockNs;
  packet.duration_ns = firings * kBlockNs;
  packet.column_ns = (traits_.lasers - 1) * traits_.firing_step_ns;
  packet.identity = static_cast<std::uint64_t>(packet.device_ns);
  packet.count = kBlocks;
  for (int block = 0; block < kBlocks; ++block) {
    const auto i = static_cast<std::size_t>(block);
    packet.turn[i] = le16(payload.data() + kHeaderBytes + i * traits_.block_bytes());
    packet.offset_ns[i] = block / returns * kBlockNs;
  }
  return DecodeStatus::kOk;
}

bool Decoder::is_data(std::span<const std::uint8_t> payload) const {
  return check(payload) == DecodeStatus::kOk;
}

DecodeStatus Decoder::check(std::span<const std::uint8_t> payload) const {
  if (payload.size() == kGpsPacketBytes && payload[0] == 0xFF && payload[1] == 0xEE) {
    return DecodeStatus::kNoPoints;
  }
  if (!has_magic(payload)) {
    return payload.size() < kHeaderBytes ? DecodeStatus::kTruncated : DecodeStatus::kGarbage;
  }
  if (payload[2] != 6 || payload[3] != 1 || payload[kLasersOffset] != traits_.lasers) {
    return DecodeStatus::kWrongModel;
  }
  const bool has_sequence = (payload[kFlagsOffset] & 1U) != 0;
  const std::size_t shortest = traits_.packet_bytes() + (has_sequence ? kSequenceBytes : 0);
  if (payload.size() < shortest) return DecodeStatus::kTruncated;
  if (payload.size() > traits_.packet_bytes() + kSequenceBytes) return DecodeStatus::kOversized;
  const std::uint8_t* tail = payload.data() + traits_.packet_bytes() - kTailBytes;
  if (payload[kBlocksOffset] != kBlocks || payload[kUnitOffset] == 0 || !time_of(tail).is_valid() ||
      returns_of(tail[kReturnModeOffset]) == 0) {
    return DecodeStatus::kGarbage;
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    if (le16(payload.data() + kHeaderBytes + block * traits_.block_bytes()) >= kFullTurn) {
      return DecodeStatus::kGarbage;
    }
  }
  return DecodeStatus::kOk;
}

std::uint32_t Decoder::decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first,
                              int end, std::int64_t since_start_ns, ScanPoint* out) const {
  const std::uint8_t* tail = payload.data() + traits_.packet_bytes() - kTailBytes;
  const bool dual = returns_of(tail[kReturnModeOffset]) == 2;
  std::uint32_t written = 0;
  for (int block = first; block < end; ++block) {
    const auto i = static_cast<std::size_t>(block);
    const std::uint8_t* at = payload.data() + kHeaderBytes + i * traits_.block_bytes();
    const std::uint8_t* other = dual && block % 2 == 1 ? at - traits_.block_bytes() : nullptr;
    written += decode_block(at, other, since_start_ns + packet.offset_ns[i], out + written);
  }
  return written;
}

std::uint32_t Decoder::decode_block(const std::uint8_t* block, const std::uint8_t* other_return,
                                    std::int64_t since_start_ns, ScanPoint* out) const {
  const std::uint32_t turn = le16(block);
  const TurnDirection& direction = directions_[turn];  // x: cosine, y: minus sine
  const auto unit_m = static_cast<float>(unit_m_);
  std::uint32_t written = 0;
  std::size_t at = kAzimuthBytes;
  for (const Beam& beam : beams_) {
    const std::uint32_t count = le16(block + at);
    const bool repeated = other_return != nullptr && le16(other_return + at) == count;
    const float range_m = static_cast<float>(count) * unit_m;
    const float across_m = range_m * beam.cos_elevation;
    const float cos_azimuth = direction.x * beam.cos_ahead + direction.y * beam.sin_ahead;
    const float sin_azimuth = direction.x * beam.sin_ahead - direction.y * beam.cos_ahead;
    // Branch-free: written always, overwritten by the next point when dropped. A branch would mispredict.
    out[written] = {across_m * sin_azimuth,
                    across_m * cos_azimuth,
                    range_m * beam.sin_elevation,
                    point_time(since_start_ns + beam.firing_ns),
                    beam.ring,
                    block[at + 2]};
    written += limits_.keeps(count, within_turn(turn + beam.ahead)) && !repeated ? 1 : 0;
    at += kReturnBytes;
  }
  return written;
}

}  // namespace isobar::hesai

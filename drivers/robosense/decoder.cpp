// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/robosense/decoder.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "drivers/lidar/civil_time.hpp"
#include "drivers/robosense/device_information.hpp"

namespace isobar::robosense {
namespace {

/// Larger azimuth steps between blocks are gaps of a restricted field of view, not rotation [0.01 deg].
constexpr std::uint32_t kMaxBlockStep = 1'000;

/// Packets in a row at another pace than the return mode's that are certain: 0.13 s.
constexpr int kCertainPackets = 100;

AngleTable nominal_angles(const ModelTraits& traits) {
  AngleTable table;
  for (std::size_t i = 0; i < static_cast<std::size_t>(traits.lasers); ++i) {
    table.elevation_deg.push_back(traits.elevation_deg[i]);
    table.azimuth_deg.push_back(traits.azimuth_deg[i]);
  }
  return table;
}

const std::uint8_t* block_at(std::span<const std::uint8_t> payload, int block) {
  return payload.data() + kHeaderBytes + static_cast<std::size_t>(block) * kBlockBytes;
}

}  // namespace

Decoder::Decoder(const ModelTraits& traits, const LidarLimits& limits, const AngleTable& angles)
    : traits_(traits),
      directions_(turn_directions()),
      keeps_angles_(angles.channels() > 0),
      has_own_angles_(keeps_angles_),
      block_ns_(2 * traits.cycle_ns) {
  use(keeps_angles_ ? angles : nominal_angles(traits));
  set_limits(limits);
}

void Decoder::use(const AngleTable& angles) {
  const std::vector<std::uint8_t> rings = angles.rings();
  for (std::size_t i = 0; i < kChannels; ++i) {
    const std::size_t laser = i % static_cast<std::size_t>(traits_.lasers);
    const double elevation_rad = angles.elevation_deg[laser] * kRadPerDeg;
    beams_[i] = {static_cast<float>(std::cos(elevation_rad)), static_cast<float>(std::sin(elevation_rad)),
                 turn_count(angles.azimuth_deg[laser]), rings[laser]};
  }
}

void Decoder::set_limits(const LidarLimits& limits) {
  constexpr std::uint32_t kMaxCount = 65'535;
  limits_ = CountLimits(limits, traits_.distance_unit_m, kMaxCount);
}

DecodeStatus Decoder::read(std::span<const std::uint8_t> payload, PacketColumns& packet) {
  const DecodeStatus status = check(payload);
  if (status == DecodeStatus::kNoPoints) read_device_information(payload);
  if (status == DecodeStatus::kWrongModel) {
    mismatch_ = "packets of a RoboSense with another header than a " + std::string(traits_.name) +
                "'s, which is configured";
  }
  if (status != DecodeStatus::kOk) return status;
  packet.device_ns = time_ns(payload.data());
  follow_pace(packet.device_ns);
  packet.duration_ns = kBlocks * block_ns_;
  packet.column_ns =
      traits_.fire_ns[static_cast<std::size_t>(traits_.lasers) - 1] + (dual_ ? 0 : traits_.cycle_ns);
  packet.identity = static_cast<std::uint64_t>(packet.device_ns);
  packet.count = kBlocks;
  for (int block = 0; block < kBlocks; ++block) {
    const auto i = static_cast<std::size_t>(block);
    packet.turn[i] = be16(block_at(payload, block) + 2);
    packet.offset_ns[i] = block * block_ns_;
  }
  return DecodeStatus::kOk;
}

bool Decoder::is_data(std::span<const std::uint8_t> payload) const {
  return check(payload) == DecodeStatus::kOk;
}

DecodeStatus Decoder::check(std::span<const std::uint8_t> payload) const {
  if (payload.size() != kPacketBytes) {
    return payload.size() < kPacketBytes ? DecodeStatus::kTruncated : DecodeStatus::kOversized;
  }
  if (std::equal(kDifopId.begin(), kDifopId.end(), payload.begin())) return DecodeStatus::kNoPoints;
  if (!std::equal(traits_.id.begin(), traits_.id.begin() + static_cast<std::ptrdiff_t>(traits_.id_bytes),
                  payload.begin())) {
    const bool is_robosense = payload[0] == 0x55 && payload[1] == 0xAA;
    return is_robosense ? DecodeStatus::kWrongModel : DecodeStatus::kGarbage;
  }
  for (int block = 0; block < kBlocks; ++block) {
    const std::uint8_t* at = block_at(payload, block);
    if (at[0] != 0xFF || at[1] != 0xEE || be16(at + 2) >= kFullTurn) return DecodeStatus::kGarbage;
  }
  return time_ns(payload.data()) >= 0 ? DecodeStatus::kOk : DecodeStatus::kGarbage;
}

/// Time of the first firing; -1: no date.
std::int64_t Decoder::time_ns(const std::uint8_t* header) const {
  const std::uint8_t* at = header + kTimeOffset;
  if (traits_.time_form == TimeForm::kSinceEpoch) {
    constexpr std::int64_t kMostSeconds = 7'000'000'000;  // the year 2191
    const std::int64_t seconds = static_cast<std::int64_t>(be16(at)) << 32 | be32(at + 2);
    const std::int64_t microseconds = be32(at + 6);
    if (seconds > kMostSeconds || microseconds >= 1'000'000) return -1;
    return seconds * 1'000'000'000 + microseconds * 1'000;
  }
  const CivilTime time{2000 + at[0],
                       at[1],
                       at[2],
                       at[3],
                       at[4],
                       at[5],
                       (be16(at + 6) * std::int64_t{1'000} + be16(at + 8)) * 1'000};
  return time.is_valid() ? time.since_epoch_ns() : -1;
}

/// The time of a block from the pace of the packets: the packets do not tell the return mode, in which a block is
/// one firing or two, and the device information with it comes once a second.
void Decoder::follow_pace(std::int64_t device_ns) {
  const std::int64_t gap_ns = (device_ns - last_ns_) / kBlocks;
  last_ns_ = device_ns;
  const std::int64_t one_ns = traits_.cycle_ns;
  if (gap_ns > one_ns * 9 / 10 && gap_ns < one_ns * 11 / 10) block_ns_ = one_ns;
  if (gap_ns > one_ns * 18 / 10 && gap_ns < one_ns * 22 / 10) block_ns_ = 2 * one_ns;
  if (!knows_mode_ || traits_.lasers == kChannels) return;
  const bool as_told = block_ns_ == (dual_ ? one_ns : 2 * one_ns);
  packets_against_mode_ = as_told ? 0 : std::min(packets_against_mode_ + 1, kCertainPackets);
}

const char* Decoder::contradiction() const {
  if (packets_against_mode_ < kCertainPackets) return nullptr;
  return dual_ ? "it sends half the packets of the dual return that its device information names: half of "
                 "them lost?"
               : "it sends twice the packets of the single return that its device information names: set its "
                 "return mode again";
}

void Decoder::read_device_information(std::span<const std::uint8_t> payload) {
  const DeviceInformation information = read_device_information_of(traits_, payload);
  dual_ = information.dual;
  knows_mode_ = true;
  sync_ = information.sync;
  if (keeps_angles_) return;
  if (const std::string rule = broken_rule(information.angles, static_cast<std::size_t>(traits_.lasers));
      !rule.empty()) {
    mismatch_ = "device information without usable angles: " + rule;
    return;
  }
  has_own_angles_ = true;
  use(information.angles);
}

std::uint32_t Decoder::decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first,
                              int end, std::int64_t since_start_ns, ScanPoint* out) const {
  std::uint32_t written = 0;
  std::uint32_t step = 0;
  for (int block = 0; block < end; ++block) {
    const auto i = static_cast<std::size_t>(block);
    if (block + 1 < kBlocks) {  // the last block reuses the step of the one before
      const std::uint32_t to_next = within_turn(packet.turn[i + 1] + kFullTurn - packet.turn[i]);
      step = to_next <= kMaxBlockStep ? to_next : step;
    }
    if (block < first) continue;
    written += decode_block({block_at(payload, block) + kBlockHeaderBytes, packet.turn[i], step,
                             since_start_ns + packet.offset_ns[i]},
                            out + written);
  }
  return written;
}

std::uint32_t Decoder::decode_block(const Block& block, ScanPoint* out) const {
  const auto unit_m = static_cast<float>(traits_.distance_unit_m);
  const auto radius_m = static_cast<float>(traits_.centre_radius_m);
  const auto lasers = static_cast<std::size_t>(traits_.lasers);
  const std::int64_t turn_ns = dual_ || lasers == kChannels ? traits_.cycle_ns : 2 * traits_.cycle_ns;
  std::uint32_t written = 0;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const Beam& beam = beams_[i];
    const std::uint8_t* channel = block.channels + i * kChannelBytes;
    const std::uint32_t count = be16(channel);
    const bool second = i >= lasers;
    const bool repeated = second && dual_ && be16(block.channels + (i - lasers) * kChannelBytes) == count;
    const std::int64_t firing_ns = traits_.fire_ns[i % lasers] + (second && !dual_ ? traits_.cycle_ns : 0);
    // Rounded down to 0.01 deg, as the maker does.
    const auto beyond = static_cast<std::uint32_t>(block.step * firing_ns / turn_ns);
    const std::uint32_t head = within_turn(block.azimuth + beyond);
    const std::uint32_t azimuth = within_turn(head + beam.ahead);
    const float range_m = static_cast<float>(count) * unit_m;
    const float across_m = range_m * beam.cos_elevation;
    const TurnDirection& direction = directions_[azimuth];
    const TurnDirection& centre = directions_[head];
    const std::int64_t since_block_ns = firing_ns * block_ns_ / turn_ns;
    // Branch-free: written always, overwritten by the next point when dropped. A branch would mispredict.
    out[written] = {across_m * direction.x + radius_m * centre.x,
                    across_m * direction.y + radius_m * centre.y,
                    range_m * beam.sin_elevation,
                    point_time(block.since_start_ns + since_block_ns),
                    beam.ring,
                    channel[2]};
    written += limits_.keeps(count, azimuth) && !repeated ? 1 : 0;
  }
  return written;
}

}  // namespace isobar::robosense

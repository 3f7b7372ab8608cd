// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/velodyne/velodyne_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/geometry.hpp"

namespace isobar::velodyne {
namespace {

constexpr double kRadPerCount = kRadPerDeg / 100.0;
/// The azimuth only grows; a fall by more than this is the passage through 0, less is jitter of the motor
/// [0.01 deg].
constexpr std::uint32_t kMaxBackwardJitter = 1'000;
/// Steps from block to block above this are gaps of a restricted field of view, not rotation: 10 deg in one
/// block would be 250 turns a second.
constexpr std::uint32_t kMaxBlockStep = 1'000;
/// ScanPoint::time_4us reaches 262 ms.
constexpr std::int64_t kMaxScanNs = 262'000'000;
/// A packet overtaken by longer than this does not belong to the open scan [ns].
constexpr std::int64_t kMaxLateNs = 50'000'000;
/// Longer silence is no packet loss but a sensor that was off [ns].
constexpr std::int64_t kMaxCountedGapNs = 60'000'000'000;

std::uint32_t read_u16(const std::uint8_t* at) { return at[0] | static_cast<std::uint32_t>(at[1]) << 8U; }
std::uint32_t read_u32(const std::uint8_t* at) { return read_u16(at) | read_u16(at + 2) << 16U; }

std::uint32_t to_count(double degrees) {
  const double turns = degrees / 360.0;
  return static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * kFullTurn)) % kFullTurn;
}

ClockAnchorConfig hourly_clock() {
  ClockAnchorConfig config;
  config.period_ns = kClockPeriodNs;
  return config;
}

}  // namespace

VelodyneDecoder::VelodyneDecoder(const VelodyneConfig& config)
    : config_(config),
      traits_(traits_of(config.model)),
      cos_azimuth_(kFullTurn),
      sin_azimuth_(kFullTurn),
      anchor_(hourly_clock()) {
  for (std::size_t laser = 0; laser < static_cast<std::size_t>(traits_.lasers); ++laser) {
    cos_elevation_[laser] = static_cast<float>(std::cos(traits_.elevation_deg[laser] * kRadPerDeg));
    sin_elevation_[laser] = static_cast<float>(std::sin(traits_.elevation_deg[laser] * kRadPerDeg));
  }
  for (std::size_t count = 0; count < kFullTurn; ++count) {
    cos_azimuth_[count] = static_cast<float>(std::cos(static_cast<double>(count) * kRadPerCount));
    sin_azimuth_[count] = static_cast<float>(std::sin(static_cast<double>(count) * kRadPerCount));
  }
  constexpr double kMaxCount = 65'535.0;
  // The small shares keep 0.3 m / 2 mm from becoming 150.00000000000003.
  min_count_ = static_cast<std::uint32_t>(
      std::clamp(std::ceil(config.min_range_m / kDistanceUnitM - 1e-6), 1.0, kMaxCount));
  max_count_ = static_cast<std::uint32_t>(
      std::clamp(std::floor(config.max_range_m / kDistanceUnitM + 1e-6), 0.0, kMaxCount));
  mask_start_ = to_count(config.mask_start_deg);
  mask_width_ = (to_count(config.mask_end_deg) + kFullTurn - mask_start_) % kFullTurn;
}

DecodeResult VelodyneDecoder::add_packet(std::span<const std::uint8_t> payload, std::int64_t host_stamp_ns,
                                         Scan& current) {
  Packet packet;
  const DecodeStatus status = inspect(payload, packet);
  if (status != DecodeStatus::kOk) {
    return {status, false};
  }
  if (seen(packet)) {
    ++counters_.duplicated;
    return {DecodeStatus::kDuplicate, false};
  }
  const std::int64_t offset_before_ns = anchor_.offset_ns();
  const auto finding = anchor_.add(static_cast<std::int64_t>(packet.timestamp_us) * 1'000, host_stamp_ns);
  packet.device_ns = anchor_.device_unwrapped_ns();
  counters_.clock_steps = anchor_.steps();
  if (pending_) {
    take_pending(current);
  }
  if (finding == ClockAnchor::Finding::kBackward) {
    return add_reordered(packet, current);
  }
  return add_in_order(packet, finding == ClockAnchor::Finding::kStep, offset_before_ns, current);
}

bool VelodyneDecoder::flush(Scan& current) {
  if (pending_) {
    take_pending(current);
  }
  if (!scan_open_) {
    return false;
  }
  complete(anchor_.offset_ns(), current);
  return true;
}

std::string VelodyneDecoder::wrong_model_message() const {
  std::array<char, 96> text{};
  const auto seen_name = product_name(wrong_product_id_);
  std::snprintf(text.data(), text.size(), "packets of %.*s (product id 0x%02X), but %.*s is configured",
                static_cast<int>(seen_name.size()), seen_name.data(),
                static_cast<unsigned>(wrong_product_id_), static_cast<int>(traits_.name.size()),
                traits_.name.data());
  return text.data();
}

DecodeStatus VelodyneDecoder::inspect(std::span<const std::uint8_t> payload, Packet& packet) {
  if (payload.size() == kPositionPacketBytes) {
    ++counters_.position;
    return DecodeStatus::kPosition;
  }
  if (payload.size() < kDataPacketBytes) {
    ++counters_.truncated;
    return DecodeStatus::kTruncated;
  }
  if (payload.size() > kDataPacketBytes) {
    ++counters_.oversized;
    return DecodeStatus::kOversized;
  }
  const auto garbage = [this] {
    ++counters_.garbage;
    return DecodeStatus::kGarbage;
  };
  packet.bytes = payload.data();
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::uint8_t* at = packet.bytes + block * kBlockBytes;
    packet.azimuth[block] = read_u16(at + 2);
    if (at[0] != kBlockFlag0 || at[1] != kBlockFlag1 || packet.azimuth[block] >= kFullTurn) {
      return garbage();
    }
  }
  const std::uint8_t product_id = packet.bytes[kProductIdOffset];
  if (product_id != static_cast<std::uint8_t>(config_.model)) {
    wrong_product_id_ = product_id;
    ++counters_.wrong_model;
    return DecodeStatus::kWrongModel;
  }
  const auto mode = static_cast<ReturnMode>(packet.bytes[kReturnModeOffset]);
  if (mode != ReturnMode::kStrongest && mode != ReturnMode::kLast && mode != ReturnMode::kDual) {
    return garbage();
  }
  packet.dual = mode == ReturnMode::kDual;
  packet.timestamp_us = read_u32(packet.bytes + kTimestampOffset);
  return DecodeStatus::kOk;
}

bool VelodyneDecoder::seen(const Packet& packet) {
  for (const Identity& identity : recent_) {
    if (identity.used && identity.timestamp_us == packet.timestamp_us &&
        identity.azimuth == packet.azimuth[0]) {
      return true;
    }
  }
  recent_[recent_next_] = {packet.timestamp_us, packet.azimuth[0], true};
  recent_next_ = (recent_next_ + 1) % recent_.size();
  return false;
}

DecodeResult VelodyneDecoder::add_in_order(const Packet& packet, bool stepped, std::int64_t offset_before_ns,
                                           Scan& current) {
  DecodeResult result;
  if (const std::int64_t gap_ns = packet.device_ns - last_device_ns_; have_last_ && gap_ns > 0) {
    shortest_gap_ns_ = shortest_gap_ns_ == 0 ? gap_ns : std::min(shortest_gap_ns_, gap_ns);
  }
  const std::uint32_t lost = stepped ? 0 : lost_before(packet);
  counters_.lost += lost;
  const int cut = first_block_of_next_scan(packet, stepped, current);
  const std::int64_t end_ns =
      packet.device_ns + traits_.firing_offset_ns(kBlocks - 1, kChannels - 1, packet.dual);
  if (cut > 0) {
    if (!scan_open_) {
      open(packet.device_ns, current);
    }
    current.packets_lost += lost;
    decode(packet, 0, cut);
    append(packet.device_ns + traits_.firing_offset_ns(cut - 1, kChannels - 1, packet.dual), current);
  }
  if (cut < kBlocks) {
    if (scan_open_) {
      complete(offset_before_ns, current);
      result.scan_complete = true;
    }
    decode(packet, cut, kBlocks);
    pending_ = true;
    pending_start_ns_ = packet.device_ns + traits_.firing_offset_ns(cut, 0, packet.dual);
    pending_end_ns_ = end_ns;
    pending_lost_ = cut == 0 ? lost : 0;
    if (!result.scan_complete) {
      take_pending(current);
    }
  }
  ++counters_.packets;
  have_last_ = true;
  last_device_ns_ = packet.device_ns;
  last_azimuth_ = packet.azimuth[kBlocks - 1];
  const std::uint32_t swept = (last_azimuth_ + kFullTurn - packet.azimuth[0]) % kFullTurn;
  const std::int64_t swept_ns = traits_.firing_offset_ns(kBlocks - 1, 0, packet.dual);
  azimuth_rate_ =
      swept < kFullTurn / 4 ? static_cast<double>(swept) / static_cast<double>(swept_ns) : azimuth_rate_;
  return result;
}

DecodeResult VelodyneDecoder::add_reordered(const Packet& packet, Scan& current) {
  ++counters_.reordered;
  if (!scan_open_) {
    open(packet.device_ns, current);
  }
  const std::int64_t early_ns = scan_start_ns_ - packet.device_ns;
  const std::uint32_t room = Scan::kMaxPoints - current.point_count;
  if (early_ns > kMaxLateNs || scan_end_ns_ - packet.device_ns > kMaxScanNs || room < kBlocks * kChannels) {
    ++counters_.too_late;
    return {DecodeStatus::kTooLate, false};
  }
  if (early_ns > 0) {  // the scan has just begun: let it begin earlier
    const auto shift = static_cast<std::uint16_t>((early_ns + kPointTimeUnitNs - 1) / kPointTimeUnitNs);
    for (std::uint32_t i = 0; i < current.point_count; ++i) {
      current.points[i].time_4us = static_cast<std::uint16_t>(current.points[i].time_4us + shift);
    }
    scan_start_ns_ -= shift * kPointTimeUnitNs;
  }
  // What came late had been counted as lost.
  counters_.lost -= counters_.lost > 0 ? 1 : 0;
  current.packets_lost -= current.packets_lost > 0 ? 1 : 0;
  decode(packet, 0, kBlocks);
  append(packet.device_ns + traits_.firing_offset_ns(kBlocks - 1, kChannels - 1, packet.dual), current);
  ++counters_.packets;
  return {};
}

std::uint32_t VelodyneDecoder::lost_before(const Packet& packet) const {
  const std::int64_t gap_ns = packet.device_ns - last_device_ns_;
  if (!have_last_ || gap_ns <= 0 || gap_ns > kMaxCountedGapNs) {
    return 0;
  }
  // A sensor that says it is an HDL-32E but keeps a VLP-16's pace has been seen: no gap is shorter than the
  // pace.
  const std::int64_t duration_ns = std::max(traits_.packet_duration_ns(packet.dual), shortest_gap_ns_);
  const std::int64_t packets = (gap_ns + duration_ns / 2) / duration_ns;
  return packets > 1 ? static_cast<std::uint32_t>(packets - 1) : 0;
}

int VelodyneDecoder::first_block_of_next_scan(const Packet& packet, bool stepped, const Scan& current) const {
  if (!have_last_) {
    return kBlocks;
  }
  const std::int64_t gap_ns = packet.device_ns - last_device_ns_;
  const bool turn_missed = azimuth_rate_ * static_cast<double>(gap_ns) > 0.9 * kFullTurn;
  const bool too_long =
      scan_open_ && packet.device_ns + traits_.packet_duration_ns(packet.dual) - scan_start_ns_ > kMaxScanNs;
  const bool full = scan_open_ && Scan::kMaxPoints - current.point_count < kBlocks * kChannels;
  if (stepped || gap_ns < 0 || turn_missed || too_long || full) {
    return 0;
  }
  std::uint32_t previous = last_azimuth_;
  for (int block = 0; block < kBlocks; ++block) {
    const std::uint32_t azimuth = packet.azimuth[static_cast<std::size_t>(block)];
    if (azimuth + kMaxBackwardJitter < previous) {
      return block;
    }
    previous = azimuth;
  }
  return kBlocks;
}

void VelodyneDecoder::decode(const Packet& packet, int first_block, int end_block) {
  point_count_ = 0;
  const int stride = packet.dual ? 2 : 1;
  std::uint32_t step = 0;
  for (int block = 0; block < end_block; ++block) {
    const int next = block / stride * stride + stride;
    if (next < kBlocks) {  // the last firing has no successor: it takes the step before it
      const std::uint32_t to_next = (packet.azimuth[static_cast<std::size_t>(next)] + kFullTurn -
                                     packet.azimuth[static_cast<std::size_t>(block)]) %
                                    kFullTurn;
      if (to_next <= kMaxBlockStep) {
        step = to_next;
      }
    }
    if (block >= first_block) {
      decode_block(packet, block, step);
    }
  }
}

void VelodyneDecoder::decode_block(const Packet& packet, int block, std::uint32_t azimuth_step) {
  const std::uint8_t* channel_bytes =
      packet.bytes + static_cast<std::size_t>(block) * kBlockBytes + kBlockHeaderBytes;
  // In dual return the odd block repeats the firing of the even one before it.
  const std::uint8_t* twin = packet.dual && block % 2 == 1 ? channel_bytes - kBlockBytes : nullptr;
  const std::uint32_t block_azimuth = packet.azimuth[static_cast<std::size_t>(block)];
  const auto block_ns = static_cast<double>(traits_.firings_per_block * traits_.firing_cycle_ns);
  const std::int64_t block_start_ns = traits_.firing_offset_ns(block, 0, packet.dual);
  for (int channel = 0; channel < kChannels; ++channel) {
    const std::uint8_t* at = channel_bytes + static_cast<std::size_t>(channel) * kChannelBytes;
    const std::uint32_t count = read_u16(at);
    const bool repeated = twin != nullptr && read_u16(twin + (at - channel_bytes)) == count;
    if (count < min_count_ || count > max_count_ || repeated) {
      continue;
    }
    const std::int64_t firing_ns = traits_.firing_offset_ns(block, channel, packet.dual);
    // Rounded to the resolution of the sensor's own azimuths: at most 0.005 deg, 0.9 mm at 10 m.
    const double counts = azimuth_step * static_cast<double>(firing_ns - block_start_ns) / block_ns;
    // Never negative, and lround would cost a call a point.
    const auto beyond = static_cast<std::uint32_t>(counts + 0.5);  // NOLINT(bugprone-incorrect-roundings)
    const std::size_t azimuth = (block_azimuth + beyond) % kFullTurn;
    if ((azimuth + kFullTurn - mask_start_) % kFullTurn < mask_width_) {
      continue;
    }
    const auto laser = static_cast<std::size_t>(channel % traits_.lasers);
    const float range = static_cast<float>(count) * static_cast<float>(kDistanceUnitM);
    const float across = range * cos_elevation_[laser];
    TimedPoint& point = points_[point_count_++];
    point.point = {across * cos_azimuth_[azimuth],
                   -across * sin_azimuth_[azimuth],
                   range * sin_elevation_[laser],
                   0,
                   traits_.ring[laser],
                   at[2]};
    point.device_ns = packet.device_ns + firing_ns;
  }
}

void VelodyneDecoder::open(std::int64_t device_ns, Scan& current) {
  scan_open_ = true;
  scan_start_ns_ = device_ns;
  scan_end_ns_ = device_ns;
  current.point_count = 0;
  current.packets_lost = 0;
  current.sequence = sequence_++;
}

void VelodyneDecoder::append(std::int64_t end_device_ns, Scan& current) {
  ScanPoint* out = current.points + current.point_count;
  for (std::size_t i = 0; i < point_count_; ++i) {
    *out = points_[i].point;
    out->time_4us = static_cast<std::uint16_t>(
        (points_[i].device_ns - scan_start_ns_ + kPointTimeUnitNs / 2) / kPointTimeUnitNs);
    ++out;
  }
  current.point_count += static_cast<std::uint32_t>(point_count_);
  counters_.returns += point_count_;
  point_count_ = 0;
  scan_end_ns_ = std::max(scan_end_ns_, end_device_ns);
}

void VelodyneDecoder::take_pending(Scan& current) {
  pending_ = false;
  open(pending_start_ns_, current);
  current.packets_lost = pending_lost_;
  append(pending_end_ns_, current);
}

void VelodyneDecoder::complete(std::int64_t offset_ns, Scan& current) {
  current.stamp_ns = scan_start_ns_ + offset_ns;
  current.end_stamp_ns = scan_end_ns_ + offset_ns;
  scan_open_ = false;
  ++counters_.scans;
}

}  // namespace isobar::velodyne

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/velodyne/velodyne_decoder.hpp"

#include <algorithm>
#include <cstdio>

namespace isobar::velodyne {
namespace {

/// Largest decrease of the azimuth by motor jitter [0.01 deg]; a larger one is the wrap-around at 0.
constexpr std::uint32_t kMaxBackwardJitter = 1'000;
/// Longest scan: range of ScanPoint::time_4us, 2^16 x 4 us.
constexpr std::int64_t kMaxScanNs = 262'000'000;
/// Largest delay with which a reordered packet is added to the open scan [ns].
constexpr std::int64_t kMaxLateNs = 50'000'000;
/// Longest gap that counts as packet loss [ns]; after a longer one the sensor was off.
constexpr std::int64_t kMaxCountedGapNs = 60'000'000'000;

ClockAnchorConfig hourly_clock() {
  ClockAnchorConfig config;
  config.period_ns = kClockPeriodNs;
  return config;
}

}  // namespace

VelodyneDecoder::VelodyneDecoder(const VelodyneConfig& config)
    : model_(config.model), traits_(traits_of(config.model)), returns_(config), anchor_(hourly_clock()) {}

DecodeResult VelodyneDecoder::add_packet(std::span<const std::uint8_t> payload, std::int64_t host_stamp_ns,
                                         Scan& current) {
  DataPacket packet;
  const DecodeStatus status = read_packet(payload, model_, packet);
  if (status != DecodeStatus::kOk) {
    count(status, packet);
    return {status, false};
  }
  if (seen(packet)) {
    ++counters_.duplicated;
    return {DecodeStatus::kDuplicate, false};
  }
  const std::int64_t offset_before_ns = anchor_.offset_ns();
  const std::int64_t sensor_ns = static_cast<std::int64_t>(packet.timestamp_us) * 1'000;
  if (continuity_.add(sensor_ns, host_stamp_ns)) clock_jumped_ns_ = host_stamp_ns;
  const auto finding = anchor_.add(sensor_ns, host_stamp_ns);
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

void VelodyneDecoder::count(DecodeStatus status, const DataPacket& packet) {
  switch (status) {
    case DecodeStatus::kPosition:
      ++counters_.position;
      break;
    case DecodeStatus::kTruncated:
      ++counters_.truncated;
      break;
    case DecodeStatus::kOversized:
      ++counters_.oversized;
      break;
    case DecodeStatus::kWrongModel:
      wrong_product_id_ = packet.product_id;
      ++counters_.wrong_model;
      break;
    default:
      ++counters_.garbage;
  }
}

bool VelodyneDecoder::seen(const DataPacket& packet) {
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

DecodeResult VelodyneDecoder::add_in_order(const DataPacket& packet, bool stepped,
                                           std::int64_t offset_before_ns, Scan& current) {
  DecodeResult result;
  if (const std::int64_t gap_ns = packet.device_ns - last_device_ns_; have_last_ && gap_ns > 0) {
    shortest_gap_ns_ = shortest_gap_ns_ == 0 ? gap_ns : std::min(shortest_gap_ns_, gap_ns);
  }
  const std::uint32_t lost = stepped ? 0 : lost_before(packet);
  counters_.lost += lost;
  const int cut = first_block_of_next_scan(packet, stepped, current);
  if (cut > 0) {
    if (!scan_open_) {
      open(packet.device_ns, current);
    }
    current.packets_lost += lost;
    append(packet, 0, cut, current);
  }
  if (cut < kBlocks) {
    if (scan_open_) {
      complete(offset_before_ns, current);
      result.scan_complete = true;
    }
    wait_for_next_scan(packet, cut, cut == 0 ? lost : 0);
    if (!result.scan_complete) {
      take_pending(current);
    }
  }
  ++counters_.packets;
  remember(packet);
  return result;
}

void VelodyneDecoder::remember(const DataPacket& packet) {
  have_last_ = true;
  last_device_ns_ = packet.device_ns;
  last_azimuth_ = packet.azimuth[kBlocks - 1];
  const std::uint32_t swept = (last_azimuth_ + kFullTurn - packet.azimuth[0]) % kFullTurn;
  const std::int64_t swept_ns = traits_.firing_offset_ns(kBlocks - 1, 0, packet.dual);
  azimuth_rate_ =
      swept < kFullTurn / 4 ? static_cast<double>(swept) / static_cast<double>(swept_ns) : azimuth_rate_;
}

DecodeResult VelodyneDecoder::add_reordered(const DataPacket& packet, Scan& current) {
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
  if (early_ns > 0) {  // earlier than the scan's first packet: move the scan's start
    const auto shift = static_cast<std::uint16_t>((early_ns + kPointTimeUnitNs - 1) / kPointTimeUnitNs);
    for (std::uint32_t i = 0; i < current.point_count; ++i) {
      current.points[i].time_4us = static_cast<std::uint16_t>(current.points[i].time_4us + shift);
    }
    scan_start_ns_ -= shift * kPointTimeUnitNs;
  }
  // The packet was counted as lost when the one after it arrived.
  counters_.lost -= counters_.lost > 0 ? 1 : 0;
  current.packets_lost -= current.packets_lost > 0 ? 1 : 0;
  append(packet, 0, kBlocks, current);
  ++counters_.packets;
  return {};
}

std::uint32_t VelodyneDecoder::lost_before(const DataPacket& packet) const {
  const std::int64_t gap_ns = packet.device_ns - last_device_ns_;
  if (!have_last_ || gap_ns <= 0 || gap_ns > kMaxCountedGapNs) {
    return 0;
  }
  // The shortest gap bounds the true packet period: an HDL-32E with the packet rate of a VLP-16 exists.
  const std::int64_t duration_ns = std::max(traits_.packet_duration_ns(packet.dual), shortest_gap_ns_);
  const std::int64_t packets = (gap_ns + duration_ns / 2) / duration_ns;
  return packets > 1 ? static_cast<std::uint32_t>(packets - 1) : 0;
}

int VelodyneDecoder::first_block_of_next_scan(const DataPacket& packet, bool stepped,
                                              const Scan& current) const {
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

void VelodyneDecoder::open(std::int64_t device_ns, Scan& current) {
  scan_open_ = true;
  scan_start_ns_ = device_ns;
  scan_end_ns_ = device_ns;
  current.point_count = 0;
  current.packets_lost = 0;
  current.sequence = sequence_++;
}

void VelodyneDecoder::append(const DataPacket& packet, int first_block, int end_block, Scan& current) {
  const std::uint32_t written =
      returns_.decode(packet, first_block, end_block, packet.device_ns - scan_start_ns_,
                      current.points + current.point_count);
  current.point_count += written;
  counters_.returns += written;
  scan_end_ns_ = std::max(
      scan_end_ns_, packet.device_ns + traits_.firing_offset_ns(end_block - 1, kChannels - 1, packet.dual));
}

void VelodyneDecoder::wait_for_next_scan(const DataPacket& packet, int first_block, std::uint32_t lost) {
  pending_ = true;
  pending_packet_ = packet;
  std::copy_n(packet.bytes, kDataPacketBytes, pending_bytes_.begin());
  pending_block_ = first_block;
  pending_lost_ = lost;
}

void VelodyneDecoder::take_pending(Scan& current) {
  pending_ = false;
  pending_packet_.bytes = pending_bytes_.data();
  open(pending_packet_.device_ns + traits_.firing_offset_ns(pending_block_, 0, pending_packet_.dual),
       current);
  current.packets_lost = pending_lost_;
  append(pending_packet_, pending_block_, kBlocks, current);
}

void VelodyneDecoder::complete(std::int64_t offset_ns, Scan& current) {
  current.stamp_ns = scan_start_ns_ + offset_ns;
  current.end_stamp_ns = scan_end_ns_ + offset_ns;
  scan_open_ = false;
  ++counters_.scans;
}

}  // namespace isobar::velodyne

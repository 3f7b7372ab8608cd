// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar/scan_assembler.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {
namespace {

/// Largest decrease of the azimuth by motor jitter [0.01 deg]; a larger one is the wrap-around at 0.
constexpr std::uint32_t kMaxBackwardJitter = 1'000;
/// Longest scan: range of ScanPoint::time_4us, 2^16 x 4 us.
constexpr std::int64_t kMaxScanNs = 262'000'000;
/// Largest delay with which a reordered packet is added to the open scan [ns].
constexpr std::int64_t kMaxLateNs = 50'000'000;
/// Longest gap that counts as packet loss [ns]; after a longer one the sensor was off.
constexpr std::int64_t kMaxCountedGapNs = 60'000'000'000;

ClockAnchorConfig clock_of(const LidarDecoder& decoder) {
  ClockAnchorConfig config;
  config.period_ns = decoder.period_ns();
  return config;
}

}  // namespace

ScanAssembler::ScanAssembler(std::unique_ptr<LidarDecoder> decoder, LidarTime time)
    : decoder_(std::move(decoder)),
      time_(time),
      anchor_(clock_of(*decoder_)),
      continuity_(decoder_->period_ns()),
      pending_bytes_(decoder_->longest_packet()) {}

DecodeResult ScanAssembler::add_packet(std::span<const std::uint8_t> payload, std::int64_t host_stamp_ns,
                                       Scan& current) {
  Packet packet;
  const DecodeStatus status = decoder_->read(payload, packet.columns);
  if (status != DecodeStatus::kOk) {
    count_refused(status, counters_);
    return {status, false};
  }
  if (seen(packet.columns)) {
    ++counters_.duplicated;
    return {DecodeStatus::kDuplicate, false};
  }
  packet.payload = payload;
  const std::int64_t offset_before_ns = anchor_.offset_ns();
  if (continuity_.add(packet.columns.device_ns, host_stamp_ns)) clock_jumped_ns_ = host_stamp_ns;
  const auto finding = anchor_.add(packet.columns.device_ns, host_stamp_ns);
  packet.device_ns = anchor_.device_unwrapped_ns();
  counters_.clock_steps = anchor_.steps();
  if (pending_) take_pending(current);
  if (finding == ClockAnchor::Finding::kBackward) return add_reordered(packet, current);
  return add_in_order(packet, finding == ClockAnchor::Finding::kStep, offset_before_ns, current);
}

bool ScanAssembler::flush(Scan& current) {
  if (pending_) take_pending(current);
  if (!scan_open_) return false;
  complete(anchor_.offset_ns(), current);
  return true;
}

bool ScanAssembler::take_imu(ImuSample& sample) {
  if (!decoder_->take_imu(sample) || counters_.packets == 0) return false;
  sample.stamp_ns += sensor_offset_ns(anchor_.offset_ns()).value_or(anchor_.offset_ns());
  sample.timing.clock_ahead_ns = anchor_.device_ahead_ns();
  return true;
}

bool ScanAssembler::seen(const PacketColumns& columns) {
  const auto end = recent_.begin() + static_cast<std::ptrdiff_t>(std::min(recent_count_, recent_.size()));
  if (std::find(recent_.begin(), end, columns.identity) != end) return true;
  recent_[recent_count_++ % recent_.size()] = columns.identity;
  return false;
}

DecodeResult ScanAssembler::add_in_order(Packet& packet, bool stepped, std::int64_t offset_before_ns,
                                         Scan& current) {
  DecodeResult result;
  packet.delay_ns = delay_after_gaps(packet.columns);
  if (const std::int64_t gap_ns = since_last_ns(packet); have_last_ && gap_ns > 0) {
    shortest_gap_ns_ = shortest_gap_ns_ == 0 ? gap_ns : std::min(shortest_gap_ns_, gap_ns);
  }
  const std::uint32_t lost = learn_sector(packet, stepped ? 0 : lost_before(packet));
  counters_.lost += lost;
  const int cut = first_column_of_next_scan(packet, stepped, current);
  if (begins_field(packet.columns)) field_ended_ = false;
  if (cut > 0) {
    if (!scan_open_) open(packet.device_ns, current);
    current.packets_lost += lost;
    append(packet, 0, cut, current);
  }
  if (cut < packet.columns.count) {
    if (scan_open_) {
      counters_.divided += is_full(current, packet.columns.count) ? 1 : 0;
      complete(offset_before_ns, current);
      result.scan_complete = true;
    }
    wait_for_next_scan(packet, cut, cut == 0 ? lost : 0);
    if (!result.scan_complete) take_pending(current);
  } else if (!field_ended_ && ends_field(packet.columns)) {
    complete(anchor_.offset_ns(), current);
    result.scan_complete = true;
    field_ended_ = true;
  }
  ++counters_.packets;
  remember(packet);
  return result;
}

/// The sensor stamps the first column only; after a gap within a packet the others fire later by the time of
/// the way across it. A packet that fits into a scan crosses less than a turn; what goes beyond is no gap.
std::int64_t ScanAssembler::delay_after_gaps(PacketColumns& columns) const {
  std::int64_t delay_ns = 0;
  if (turn_rate_ <= 0.0) return delay_ns;
  const auto longest_ns = static_cast<double>(kMaxScanNs - columns.last_offset_ns() - columns.column_ns);
  for (std::size_t i = 1; i < static_cast<std::size_t>(columns.count); ++i) {
    const std::uint32_t step = turn_between(columns.turn[i - 1], columns.turn[i]);
    if (step >= BlindSector::kLeast && step <= kFullTurn - BlindSector::kLeast) {
      const double gap_ns = step / turn_rate_;
      if (static_cast<double>(delay_ns) + gap_ns < longest_ns) delay_ns += std::llround(gap_ns);
    }
    columns.offset_ns[i] += delay_ns;
  }
  return delay_ns;
}

std::uint32_t ScanAssembler::learn_sector(const Packet& packet, std::uint32_t lost) {
  if (!have_last_ || since_last_ns(packet) > kMaxScanNs) return lost;
  std::uint32_t none = blind_.add(last_turn_, packet.columns.first_turn(), lost);
  for (std::size_t i = 1; i < static_cast<std::size_t>(packet.columns.count); ++i) {
    none += blind_.add(packet.columns.turn[i - 1], packet.columns.turn[i], 0);
  }
  const std::uint32_t here = std::min(lost, none);
  counters_.lost -= std::min<std::uint64_t>(counters_.lost, none - here);
  return lost - here;
}

void ScanAssembler::remember(const Packet& packet) {
  const PacketColumns& columns = packet.columns;
  have_last_ = true;
  last_device_ns_ = packet.device_ns + packet.delay_ns;
  last_turn_ = columns.last_turn();
  const std::uint32_t swept = turn_between(columns.first_turn(), last_turn_);
  const std::int64_t swept_ns = columns.last_offset_ns();
  if (swept < kFullTurn / 4 && swept_ns > 0) {
    turn_rate_ = static_cast<double>(swept) / static_cast<double>(swept_ns);
  }
}

DecodeResult ScanAssembler::add_reordered(const Packet& packet, Scan& current) {
  ++counters_.reordered;
  if (!scan_open_) open(packet.device_ns, current);
  const std::int64_t early_ns = scan_start_ns_ - packet.device_ns;
  if (early_ns > kMaxLateNs || scan_end_ns_ - packet.device_ns > kMaxScanNs || is_too_long_with(packet) ||
      is_full(current, packet.columns.count)) {
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
  append(packet, 0, packet.columns.count, current);
  ++counters_.packets;
  return {};
}

std::uint32_t ScanAssembler::lost_before(const Packet& packet) const {
  std::int64_t gap_ns = since_last_ns(packet);
  if (!have_last_ || gap_ns <= 0 || gap_ns > kMaxCountedGapNs) return 0;
  if (blind_.crossed(last_turn_, packet.columns.first_turn()) && turn_rate_ > 0.0) {
    gap_ns -= std::llround(blind_.width() / turn_rate_);
  }
  // The shortest gap bounds the true packet period.
  const std::int64_t duration_ns = std::max(packet.columns.duration_ns, shortest_gap_ns_);
  const std::int64_t packets = (gap_ns + duration_ns / 2) / duration_ns;
  return packets > 1 ? static_cast<std::uint32_t>(packets - 1) : 0;
}

int ScanAssembler::first_column_of_next_scan(const Packet& packet, bool stepped, const Scan& current) const {
  const PacketColumns& columns = packet.columns;
  if (!have_last_) return columns.count;
  const std::int64_t gap_ns = since_last_ns(packet);
  const bool turn_missed = turn_rate_ * static_cast<double>(gap_ns) > 0.9 * kFullTurn;
  const bool full = scan_open_ && (is_too_long_with(packet) || is_full(current, columns.count));
  if (stepped || gap_ns < 0 || turn_missed || full) return 0;
  if (field_ended_) return columns.count;
  std::uint32_t previous = last_turn_;
  for (int column = 0; column < columns.count; ++column) {
    const std::uint32_t turn = columns.turn[static_cast<std::size_t>(column)];
    if (is_next_turn(previous, turn)) return column;
    previous = turn;
  }
  return columns.count;
}

bool ScanAssembler::is_next_turn(std::uint32_t previous, std::uint32_t turn) const {
  if (blind_.known()) return blind_.crossed(previous, turn);
  return turn + kMaxBackwardJitter < previous;
}

/// Whether less than a packet is missing to the end of a reduced field of view. The rest comes a turn later,
/// with the first columns of the next scan.
bool ScanAssembler::ends_field(const PacketColumns& columns) const {
  if (!blind_.known()) return false;
  const auto packet = static_cast<std::uint32_t>(turn_rate_ * static_cast<double>(columns.duration_ns));
  const std::uint32_t rest = turn_between(columns.last_turn(), blind_.from());
  return rest < packet || rest > kFullTurn - BlindSector::kTolerance;
}

/// Whether the packet is, or holds, the first of a new turn of a reduced field of view.
bool ScanAssembler::begins_field(const PacketColumns& columns) const {
  if (!blind_.known()) return true;
  std::uint32_t previous = last_turn_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(columns.count); ++i) {
    if (blind_.crossed(previous, columns.turn[i])) return true;
    previous = columns.turn[i];
  }
  return false;
}

/// Whether the scan would last longer than its points' times can say if it took the packet.
bool ScanAssembler::is_too_long_with(const Packet& packet) const {
  const PacketColumns& columns = packet.columns;
  const std::int64_t length_ns = std::max(columns.duration_ns, columns.last_offset_ns() + columns.column_ns);
  return packet.device_ns + length_ns - scan_start_ns_ > kMaxScanNs;
}

bool ScanAssembler::is_full(const Scan& current, int columns) const {
  return Scan::kMaxPoints - current.point_count <
         static_cast<std::uint32_t>(columns) * decoder_->points_per_column();
}

void ScanAssembler::open(std::int64_t device_ns, Scan& current) {
  scan_open_ = true;
  scan_start_ns_ = device_ns;
  scan_end_ns_ = device_ns;
  current.point_count = 0;
  current.packets_lost = 0;
  current.sequence = sequence_++;
}

void ScanAssembler::append(const Packet& packet, int first, int end, Scan& current) {
  const std::uint32_t written =
      decoder_->decode(packet.payload, packet.columns, first, end, packet.device_ns - scan_start_ns_,
                       current.points + current.point_count);
  current.point_count += written;
  counters_.returns += written;
  const std::int64_t last_ns = packet.columns.offset_ns[static_cast<std::size_t>(end) - 1];
  scan_end_ns_ = std::max(scan_end_ns_, packet.device_ns + last_ns + packet.columns.column_ns);
}

void ScanAssembler::wait_for_next_scan(const Packet& packet, int first, std::uint32_t lost) {
  pending_ = true;
  pending_packet_ = packet;
  std::copy(packet.payload.begin(), packet.payload.end(), pending_bytes_.begin());
  pending_packet_.payload = std::span(pending_bytes_).first(packet.payload.size());
  pending_column_ = first;
  pending_lost_ = lost;
}

void ScanAssembler::take_pending(Scan& current) {
  pending_ = false;
  open(pending_packet_.device_ns +
           pending_packet_.columns.offset_ns[static_cast<std::size_t>(pending_column_)],
       current);
  current.packets_lost = pending_lost_;
  append(pending_packet_, pending_column_, pending_packet_.columns.count, current);
}

/// The offset of the sensor's clock, if that is to stamp the points and can.
std::optional<std::int64_t> ScanAssembler::sensor_offset_ns(std::int64_t measured_ns) const {
  if (time_ == LidarTime::kReceive || !may_stamp(decoder_->sync())) return std::nullopt;
  return whole_seconds_ns(measured_ns);
}

void ScanAssembler::complete(std::int64_t offset_ns, Scan& current) {
  const std::optional<std::int64_t> by_sensor_ns = sensor_offset_ns(offset_ns);
  sensor_stamps_ = by_sensor_ns.has_value();
  offset_ns = by_sensor_ns.value_or(offset_ns);
  current.stamp_ns = scan_start_ns_ + offset_ns;
  current.end_stamp_ns = scan_end_ns_ + offset_ns;
  scan_open_ = false;
  ++counters_.scans;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/decoder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace isobar::ouster {
namespace {

/// Latest time of a column that is accepted: the year 2096.
constexpr std::uint64_t kMostTimestampNs = 4'000'000'000'000'000'000;
/// Earliest time since 1970 of a clock that has been set: the year 2001.
constexpr std::uint64_t kLeastSetClockNs = 1'000'000'000'000'000'000;
/// Longest packet: 64 columns of a slow turn need 25 ms.
constexpr std::uint64_t kMostPacketNs = 100'000'000;
constexpr std::uint32_t kLidarPacket = 1;

}  // namespace

Decoder::Decoder(std::string_view model, Metadata metadata, const LidarLimits& limits)
    : model_(model),
      metadata_(std::move(metadata)),
      layout_(*metadata_.profile, metadata_.pixels, metadata_.columns_per_packet,
              metadata_.has_safety_header),
      geometry_(metadata_),
      imu_(metadata_),
      evidence_(metadata_.columns_per_turn) {
  set_limits(limits);
}

void Decoder::set_limits(const LidarLimits& limits) {
  limits_ = CountLimits(limits, layout_.profile().range_unit_m, layout_.profile().range_mask);
}

std::uint32_t Decoder::points_per_column() const {
  return static_cast<std::uint32_t>(layout_.pixels()) * static_cast<std::uint32_t>(layout_.profile().returns);
}

DecodeStatus Decoder::read(std::span<const std::uint8_t> payload, PacketColumns& packet) {
  imu_.clear();
  if (imu_.is_imu(payload) && payload.size() != layout_.packet_bytes()) {
    imu_.read(payload);
    return DecodeStatus::kNoPoints;
  }
  const DecodeStatus size = check_size(payload.size());
  if (size != DecodeStatus::kOk) {
    if (size == DecodeStatus::kWrongModel) fault_ = Fault::kSize;
    other_bytes_ = payload.size();
    return size;
  }
  const PacketHeader header = layout_.header(payload.data());
  if (layout_.profile().has_header && (header.type & 0xFFU) != kLidarPacket) return DecodeStatus::kGarbage;
  if (const Fault fault = check_header(header); fault != Fault::kNone) {
    fault_ = fault;
    other_header_ = header;
    return DecodeStatus::kWrongModel;
  }
  return read_columns(payload.data(), packet);
}

DecodeStatus Decoder::check_size(std::size_t bytes) const {
  if (bytes == layout_.packet_bytes()) return DecodeStatus::kOk;
  if (!formats_of_size(bytes).empty()) return DecodeStatus::kWrongModel;
  return bytes < layout_.packet_bytes() ? DecodeStatus::kTruncated : DecodeStatus::kOversized;
}

Decoder::Fault Decoder::check_header(const PacketHeader& header) const {
  if (!layout_.profile().has_header) return Fault::kNone;
  if (header.type != kLidarPacket) return Fault::kHeader;
  if (metadata_.serial != 0 && header.serial != 0) {
    return metadata_.serial == header.serial ? Fault::kNone : Fault::kSerial;
  }
  const bool other_start =
      metadata_.init_id != 0 && header.init_id != 0 && metadata_.init_id != header.init_id;
  return other_start ? Fault::kStart : Fault::kNone;
}

DecodeStatus Decoder::read_columns(const std::uint8_t* bytes, PacketColumns& packet) {
  TurnEvidence::Span span{};
  packet.count = 0;
  for (std::size_t i = 0; i < layout_.columns(); ++i) {
    const std::uint8_t* column = layout_.column(bytes, i);
    if (!layout_.is_valid(column)) continue;
    const std::uint32_t id = PacketLayout::measurement_id(column);
    const std::uint64_t time_ns = PacketLayout::timestamp_ns(column);
    if (time_ns > kMostTimestampNs || id >= kMostColumnsPerTurn) return DecodeStatus::kGarbage;
    const auto stamp_ns = static_cast<std::int64_t>(time_ns);
    if (packet.count == 0) span = {id, id, stamp_ns, stamp_ns};
    const bool in_order = stamp_ns >= span.last_ns && stamp_ns - span.first_ns <= std::int64_t{kMostPacketNs};
    if (!in_order || (packet.count > 0 && id <= span.last_id)) return DecodeStatus::kGarbage;
    span.last_id = id;
    span.last_ns = stamp_ns;
    const auto at = static_cast<std::size_t>(packet.count++);
    packet.turn[at] = geometry_.turn(id) % kFullTurn;
    packet.offset_ns[at] = stamp_ns - span.first_ns;
  }
  if (packet.count == 0) return DecodeStatus::kNoPoints;  // outside the azimuth window
  evidence_.add(span);
  if (evidence_.contradicts()) {
    fault_ = Fault::kColumns;
    return DecodeStatus::kWrongModel;
  }
  packet.device_ns = span.first_ns;
  packet.column_ns = 0;
  packet.duration_ns =
      std::llround(1e9 * metadata_.columns_per_packet / (metadata_.columns_per_turn * metadata_.turn_hz));
  packet.identity = static_cast<std::uint64_t>(span.first_ns) ^ std::uint64_t{span.first_id} << 48U;
  sync_ = sync_at(static_cast<std::uint64_t>(span.first_ns));
  return DecodeStatus::kOk;
}

/// Packets do not tell whether the clock is locked: a clock that was set counts from 1970, any other from the
/// sensor's start.
LidarSync Decoder::sync_at(std::uint64_t timestamp_ns) const {
  const bool is_set = timestamp_ns >= kLeastSetClockNs;
  switch (metadata_.timestamp_mode) {
    case TimestampMode::kInternal:
      return LidarSync::kFree;
    case TimestampMode::kPtp:
      return is_set ? LidarSync::kLocked : LidarSync::kLocking;
    case TimestampMode::kSyncPulse:
      return is_set ? LidarSync::kLocked : LidarSync::kUnknown;
    case TimestampMode::kUnknown:
      break;
  }
  return LidarSync::kUnknown;
}

bool Decoder::is_data(std::span<const std::uint8_t> payload) const {
  return payload.size() == layout_.packet_bytes() &&
         check_header(layout_.header(payload.data())) == Fault::kNone;
}

std::uint32_t Decoder::decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first,
                              int end, std::int64_t since_start_ns, ScanPoint* out) const {
  std::uint32_t written = 0;
  int valid = 0;
  for (std::size_t i = 0; i < layout_.columns() && valid < end; ++i) {
    const std::uint8_t* column = layout_.column(payload.data(), i);
    if (!layout_.is_valid(column)) continue;
    const int at = valid++;
    if (at < first) continue;
    const std::int64_t time_ns = since_start_ns + packet.offset_ns[static_cast<std::size_t>(at)];
    written += decode_column(column, point_time(time_ns), out + written);
  }
  return written;
}

std::uint32_t Decoder::decode_column(const std::uint8_t* column, std::uint16_t time_4us,
                                     ScanPoint* out) const {
  const Profile& profile = layout_.profile();
  const std::uint32_t id = PacketLayout::measurement_id(column);
  const BeamGeometry::Column& geometry = geometry_.column(id);
  const std::uint32_t turn = geometry_.turn(id);
  const auto unit_m = static_cast<float>(profile.range_unit_m);
  const std::uint8_t* pixel = layout_.pixels_of(column);
  std::uint32_t written = 0;
  for (const BeamGeometry::Beam& beam : geometry_.beams()) {
    const std::uint32_t azimuth = within_turn(turn + beam.ahead);
    std::uint32_t stronger = 0;
    for (int i = 0; i < profile.returns; ++i) {
      const std::uint8_t* at = pixel + static_cast<std::size_t>(i) * Profile::kReturnBytes;
      const std::uint32_t count = le32(at) & profile.range_mask;
      const std::uint8_t* reflectivity = at + profile.reflectivity_offset;
      const std::uint32_t intensity = profile.wide_reflectivity ? le16(reflectivity) : *reflectivity;
      ScanPoint& point = out[written];
      point = geometry_.point(geometry, beam, static_cast<float>(count) * unit_m);
      point.time_4us = time_4us;
      point.intensity = static_cast<std::uint8_t>(std::min<std::uint32_t>(intensity, 255));
      written += limits_.keeps(count, azimuth) && count != stronger ? 1 : 0;
      stronger = count;
    }
    pixel += profile.pixel_bytes;
  }
  return written;
}

/// Short texts: the status shows 119 characters.
std::string Decoder::mismatch() const {
  const std::string file = std::filesystem::path(metadata_.file).filename().string();
  switch (fault_) {
    case Fault::kSize:
      return "packets of " + std::to_string(other_bytes_) + " bytes, but " + file + " says " +
             std::to_string(layout_.packet_bytes()) + " (" + std::to_string(layout_.pixels()) + " beams, " +
             std::string(layout_.profile().name) + "); theirs: " + formats_of_size(other_bytes_);
    case Fault::kHeader:
      return "packets with the header of functional safety, but " + file + " says " +
             std::string(layout_.profile().name);
    case Fault::kSerial:
      return "packets of the sensor with serial number " + std::to_string(other_header_.serial) + ", but " +
             file + " is of " + std::to_string(metadata_.serial) + " (" + metadata_.product_line + ")";
    case Fault::kStart:
      return "packets with initialisation id " + std::to_string(other_header_.init_id) + ", but " + file +
             " has " + std::to_string(metadata_.init_id) + " and no serial number: read it again";
    case Fault::kColumns:
      return "packets of " + std::to_string(evidence_.seen_columns()) + " columns a turn or more, but " +
             file + " says " + std::to_string(metadata_.columns_per_turn) + " (lidar_mode)";
    case Fault::kNone:
      break;
  }
  return "packets of another sensor than that of " + file;
}

}  // namespace isobar::ouster

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/livox/decoder.hpp"

#include <bit>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar::livox {
namespace {

constexpr std::uint64_t kMostTimestampNs = 4'000'000'000'000'000'000;
constexpr double kStandardGravity = 9.80665;
constexpr std::uint32_t kLowConfidence = 2;

std::uint8_t type_of(std::span<const std::uint8_t> payload) { return payload[10]; }
std::size_t samples_of(std::span<const std::uint8_t> payload) { return le16(payload.data() + 5); }
std::int64_t interval_ns(std::span<const std::uint8_t> payload) {
  return std::int64_t{le16(payload.data() + 3)} * 100;
}

bool is_points(std::uint8_t type) {
  return type == static_cast<std::uint8_t>(DataType::kCartesian) ||
         type == static_cast<std::uint8_t>(DataType::kShort);
}

/// Bits 0-1: between two objects, 2-3: rain or dust, 4-5: other.
bool is_doubtful(std::uint32_t tag) {
  return (tag & 3U) == kLowConfidence || (tag >> 2U & 3U) == kLowConfidence ||
         (tag >> 4U & 3U) == kLowConfidence;
}

Eigen::Vector3d floats_at(const std::uint8_t* at) {
  return {std::bit_cast<float>(le32(at)), std::bit_cast<float>(le32(at + 4)),
          std::bit_cast<float>(le32(at + 8))};
}

ScanPoint cartesian_at(const std::uint8_t* at) {
  const auto axis_m = [at](std::size_t i) {
    return static_cast<float>(static_cast<std::int32_t>(le32(at + 4 * i))) * 1e-3F;
  };
  return {axis_m(0), axis_m(1), axis_m(2), 0, 0, at[12]};
}

ScanPoint short_at(const std::uint8_t* at) {
  const auto axis_m = [at](std::size_t i) {
    return static_cast<float>(static_cast<std::int16_t>(le16(at + 2 * i))) * 1e-2F;
  };
  return {axis_m(0), axis_m(1), axis_m(2), 0, 0, at[6]};
}

/// Whether version, type, length and number of samples fit together.
DecodeStatus check_frame(std::span<const std::uint8_t> payload) {
  if (payload.size() < kHeaderBytes) return DecodeStatus::kTruncated;
  const std::size_t length = le16(payload.data() + 1);
  if (payload[0] != 0 || length < kHeaderBytes) return DecodeStatus::kGarbage;
  if (payload.size() != length) {
    return payload.size() < length ? DecodeStatus::kTruncated : DecodeStatus::kOversized;
  }
  const std::size_t bytes = sample_bytes(type_of(payload));
  const std::size_t samples = samples_of(payload);
  const bool fits =
      bytes != 0 && samples != 0 && samples <= kMostPoints && length == kHeaderBytes + samples * bytes;
  return fits && le64(payload.data() + kCheckedAt) <= kMostTimestampNs ? DecodeStatus::kOk
                                                                       : DecodeStatus::kGarbage;
}

}  // namespace

void Decoder::set_limits(const LidarLimits& limits) {
  min_range_m_ = limits.min_range_m;
  max_range_m_ = limits.max_range_m;
  mask_start_deg_ = limits.mask_start_deg;
  mask_width_deg_ = std::fmod(limits.mask_end_deg - limits.mask_start_deg + 360.0, 360.0);
}

DecodeStatus Decoder::read(std::span<const std::uint8_t> payload, PacketColumns& packet) {
  has_imu_ = false;
  const DecodeStatus frame = check_frame(payload);
  if (frame != DecodeStatus::kOk) return frame;
  if (!has_right_checksum(payload)) return DecodeStatus::kGarbage;
  const std::uint64_t stamp_ns = le64(payload.data() + kCheckedAt);
  const std::uint8_t time_type = payload[11];
  sync_ = time_type == 0 ? LidarSync::kFree : time_type <= 2 ? LidarSync::kLocked : LidarSync::kUnknown;
  if (type_of(payload) == static_cast<std::uint8_t>(DataType::kImu)) {
    read_imu(payload.data() + kHeaderBytes, stamp_ns);
    return DecodeStatus::kNoPoints;
  }
  if (!is_points(type_of(payload))) {
    other_type_ = type_of(payload);
    return DecodeStatus::kWrongModel;
  }
  packet.device_ns = static_cast<std::int64_t>(stamp_ns);
  packet.column_ns = interval_ns(payload);
  const auto samples = static_cast<std::int64_t>(samples_of(payload));
  // One interval between points more than from the first to the last.
  packet.duration_ns =
      std::max<std::int64_t>(packet.column_ns * samples / std::max<std::int64_t>(samples - 1, 1), 1);
  packet.identity = stamp_ns;
  packet.count = 1;
  packet.turn[0] =
      static_cast<std::uint32_t>(packet.device_ns % kSliceNs * std::int64_t{kFullTurn} / kSliceNs);
  packet.offset_ns[0] = 0;
  return DecodeStatus::kOk;
}

bool Decoder::has_right_checksum(std::span<const std::uint8_t> payload) {
  const std::uint32_t stated = le32(payload.data() + 24);
  if (stated == 0 || checksums_ == Checksums::kUnused) return true;
  const bool is_right = stated == crc32(payload.subspan(kCheckedAt));
  if (is_right) checksums_ = Checksums::kUsed;
  if (is_right || checksums_ == Checksums::kUsed) return is_right;
  if (++wrong_checksums_ >= kUnprovenPackets) checksums_ = Checksums::kUnused;
  return false;
}

bool Decoder::is_data(std::span<const std::uint8_t> payload) const {
  return check_frame(payload) == DecodeStatus::kOk && is_points(type_of(payload));
}

std::uint32_t Decoder::decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first,
                              int end, std::int64_t since_start_ns, ScanPoint* out) const {
  if (first >= end) return 0;
  const bool is_short = type_of(payload) == static_cast<std::uint8_t>(DataType::kShort);
  const std::size_t bytes = sample_bytes(type_of(payload));
  const auto samples = static_cast<std::int64_t>(samples_of(payload));
  const std::int64_t steps = std::max<std::int64_t>(samples - 1, 1);
  const std::uint8_t* at = payload.data() + kHeaderBytes;
  std::uint32_t written = 0;
  for (std::int64_t i = 0; i < samples; ++i, at += bytes) {
    ScanPoint point = is_short ? short_at(at) : cartesian_at(at);
    point.time_4us = point_time(since_start_ns + packet.offset_ns[0] + packet.column_ns * i / steps);
    if (is_doubtful(at[bytes - 1]) || !keeps(point)) continue;
    out[written++] = point;
  }
  return written;
}

bool Decoder::keeps(const ScanPoint& point) const {
  const double x = point.x_m;
  const double y = point.y_m;
  const double z = point.z_m;
  const double range_m = std::sqrt(x * x + y * y + z * z);
  // 1e-6: the coordinates are rounded to floats.
  if (range_m <= 0.0 || range_m < min_range_m_ - 1e-6 || range_m > max_range_m_ + 1e-6) return false;
  if (mask_width_deg_ <= 0.0) return true;
  const double azimuth_deg = -std::atan2(y, x) / kRadPerDeg;  // clockwise from above
  return std::fmod(azimuth_deg - mask_start_deg_ + 720.0, 360.0) >= mask_width_deg_;
}

void Decoder::read_imu(const std::uint8_t* bytes, std::uint64_t stamp_ns) {
  const Eigen::Vector3d gyro = floats_at(bytes);
  const Eigen::Vector3d accel = floats_at(bytes + 12);
  if (!gyro.allFinite() || !accel.allFinite()) return;
  imu_ = {};
  imu_.stamp_ns = static_cast<std::int64_t>(stamp_ns);
  imu_.gyro_rad_s = gyro;
  imu_.accel_m_s2 = accel * kStandardGravity;
  has_imu_ = true;
}

bool Decoder::take_imu(ImuSample& sample) {
  if (!has_imu_) return false;
  sample = imu_;
  has_imu_ = false;
  return true;
}

std::string Decoder::mismatch() const {
  return "points of type " + std::to_string(other_type_) +
         ", but types 1 and 2 are decoded: set the sensor to Cartesian coordinates (pcl_data_type)";
}

}  // namespace isobar::livox

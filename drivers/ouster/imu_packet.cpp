// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/imu_packet.hpp"

#include <bit>

#include "core/geometry.hpp"

namespace isobar::ouster {
namespace {

constexpr std::size_t kLegacyBytes = 48;
constexpr std::size_t kBlocksAt = PacketLayout::kHeaderBytes + 100;
constexpr std::size_t kBlockBytes = 36;
constexpr std::uint64_t kMostStampNs = 4'000'000'000'000'000'000;

Eigen::Vector3d vector_at(const std::uint8_t* at) {
  return {std::bit_cast<float>(le32(at)), std::bit_cast<float>(le32(at + 4)),
          std::bit_cast<float>(le32(at + 8))};
}

}  // namespace

bool ImuReader::is_imu(std::span<const std::uint8_t> payload) const {
  if (profile_ == ImuProfile::kLegacy) return payload.size() == kLegacyBytes;
  constexpr std::size_t kFrame = kBlocksAt + PacketLayout::kFooterBytes;
  return payload.size() > kFrame && (payload.size() - kFrame) % kBlockBytes == 0 &&
         (payload.size() - kFrame) / kBlockBytes <= kMostSamples;
}

void ImuReader::read(std::span<const std::uint8_t> payload) {
  clear();
  if (profile_ == ImuProfile::kLegacy) {
    add(le64(payload.data() + 16), payload.data() + 24, kGravityM_S2, kRadPerDeg);
    return;
  }
  const std::size_t end = payload.size() - PacketLayout::kFooterBytes;
  for (std::size_t at = kBlocksAt; at < end; at += kBlockBytes) {
    const std::uint8_t* block = payload.data() + at;
    if ((block[10] & 1U) != 0) add(le64(block), block + 12, 1.0, 1.0);
  }
}

void ImuReader::add(std::uint64_t stamp_ns, const std::uint8_t* values, double accel_unit, double gyro_unit) {
  const Eigen::Vector3d accel = vector_at(values);
  const Eigen::Vector3d gyro = vector_at(values + 12);
  if (!accel.allFinite() || !gyro.allFinite() || stamp_ns > kMostStampNs) return;
  ImuSample sample;
  sample.stamp_ns = static_cast<std::int64_t>(stamp_ns);
  sample.accel_m_s2 = R_sensor_imu_ * accel * accel_unit;
  sample.gyro_rad_s = R_sensor_imu_ * gyro * gyro_unit;
  samples_[count_++] = sample;
}

bool ImuReader::take(ImuSample& sample) {
  if (next_ == count_) return false;
  sample = samples_[next_++];
  return true;
}

}  // namespace isobar::ouster

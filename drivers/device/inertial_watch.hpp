// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>

#include "core/plausibility.hpp"
#include "drivers/device/fault_watch.hpp"

namespace isobar {

/// Judges the samples of an inertial device: plausible, and not frozen.
class InertialWatch {
 public:
  /// Time after which values whose bits do not change are stuck [ns]: the noise of MEMS sensors moves the last
  /// bits of every sample.
  static constexpr std::int64_t kStuckNs = 1'000'000'000;

  enum class Verdict : std::uint8_t { kGood, kRefused, kStuck };
  /// Judges a sample and tells `faults`; after kStuck the device fails.
  Verdict judge(const ImuSample& imu, std::int64_t now_ns, FaultWatch& faults) noexcept {
    if (const char* rule = implausibility(imu); rule != nullptr) {
      ++faults.counters().implausible;
      faults.problem(DeviceState::kImplausible, rule);
      return Verdict::kRefused;
    }
    if (stuck_.add(bits_of(imu), now_ns)) {
      if (faults.status().state != DeviceState::kStuck) ++faults.counters().stuck;
      return Verdict::kStuck;
    }
    faults.good(now_ns);
    return Verdict::kGood;
  }

 private:
  /// Hash of the bits of the six values.
  static std::int64_t bits_of(const ImuSample& imu) noexcept {
    std::uint64_t bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bits = std::rotl(bits, 7) ^ std::bit_cast<std::uint64_t>(imu.gyro_rad_s[axis]);
      bits = std::rotl(bits, 7) ^ std::bit_cast<std::uint64_t>(imu.accel_m_s2[axis]);
    }
    return std::bit_cast<std::int64_t>(bits);
  }

  StuckWatch stuck_{kStuckNs};
};

}  // namespace isobar

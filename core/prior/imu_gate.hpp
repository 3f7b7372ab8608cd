// SPDX-License-Identifier: BSD-3-Clause
// Validation of IMU samples: value, time, gaps and jumps of the clock.
#pragma once

#include <cstdint>

#include "core/prior/prior_config.hpp"
#include "core/samples.hpp"

namespace isobar {

enum class ImuStatus : std::uint8_t {
  kFirst,     ///< first sample
  kNext,      ///< follows the sample before
  kGap,       ///< follows after more than PriorLimits::imu_gap_s
  kRestart,   ///< the clock has jumped, confirmed by a second sample
  kBadValue,  ///< refused: not finite or beyond the sensor's range
  kBadTime,   ///< refused: not newer, or an unconfirmed jump
};

/// Checks one sample after the other.
class ImuGate {
 public:
  explicit ImuGate(const PriorLimits& limits) : limits_(limits) {}

  void configure(const PriorLimits& limits) { limits_ = limits; }

  ImuStatus check(const ImuSample& sample);
  /// Time since the sample before; 0 with kFirst and after a jump back.
  [[nodiscard]] double dt_s() const { return dt_s_; }
  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] std::int64_t stamp_ns() const { return stamp_ns_; }

 private:
  [[nodiscard]] bool plausible(const ImuSample& sample) const;

  PriorLimits limits_;
  std::int64_t stamp_ns_ = 0;
  std::int64_t candidate_ns_ = 0;  // time of the last refused jump, until a second sample confirms it
  double dt_s_ = 0.0;
  bool has_candidate_ = false;
  bool started_ = false;
};

}  // namespace isobar

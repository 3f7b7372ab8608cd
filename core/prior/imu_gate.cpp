// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/imu_gate.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"

namespace isobar {
namespace {

// A jump of the clock is confirmed by a second sample within this time after the first.
constexpr double kConfirmationS = 1.0;

}  // namespace

bool ImuGate::plausible(const ImuSample& sample) const {
  // allFinite() first: maxCoeff() may ignore NaN.
  const bool finite = sample.gyro_rad_s.allFinite() && sample.accel_m_s2.allFinite();
  if (!finite || sample.gyro_rad_s.cwiseAbs().maxCoeff() > limits_.max_gyro_rad_s) return false;
  return sample.accel_m_s2.cwiseAbs().maxCoeff() <= limits_.max_accel_m_s2;
}

ImuStatus ImuGate::check(const ImuSample& sample) {
  if (!plausible(sample)) return ImuStatus::kBadValue;
  if (!plausible_stamp(sample.stamp_ns)) return ImuStatus::kBadTime;
  dt_s_ = started_ ? seconds_between(stamp_ns_, sample.stamp_ns) : 0.0;
  if (!started_) {
    started_ = true;
    stamp_ns_ = sample.stamp_ns;
    return ImuStatus::kFirst;
  }
  if (std::abs(dt_s_) > limits_.imu_restart_s) {
    const double after_candidate_s = seconds_between(candidate_ns_, sample.stamp_ns);
    const bool agrees = has_candidate_ && after_candidate_s > 0.0 && after_candidate_s < kConfirmationS;
    has_candidate_ = !agrees;
    candidate_ns_ = sample.stamp_ns;
    if (!agrees) return ImuStatus::kBadTime;
    stamp_ns_ = sample.stamp_ns;
    dt_s_ = std::max(dt_s_, 0.0);
    return ImuStatus::kRestart;
  }
  if (dt_s_ <= 0.0) return ImuStatus::kBadTime;
  has_candidate_ = false;
  stamp_ns_ = sample.stamp_ns;
  return dt_s_ > limits_.imu_gap_s ? ImuStatus::kGap : ImuStatus::kNext;
}

}  // namespace isobar

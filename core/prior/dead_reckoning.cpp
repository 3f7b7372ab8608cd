// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"

namespace isobar {
namespace {

// A jump of speed is accepted with the fifth consecutive sample that shows it.
constexpr int kConfirmingSamples = 5;
// Change of the speed by the encoders' quantisation alone.
constexpr double kSpeedNoiseMS = 0.5;

Eigen::Vector2d velocity(const WheelSample& sample) { return {sample.vx_m_s, sample.vy_m_s}; }

}  // namespace

bool WheelOdometer::plausible(const WheelSample& sample, double dt_s) {
  // With <= so that NaN fails.
  const bool in_range = velocity(sample).norm() <= config_.max_speed_m_s &&
                        std::abs(sample.wz_rad_s) <= config_.max_turn_rate_rad_s;
  if (!in_range) return false;
  const double jump = (velocity(sample) - velocity(last_)).norm();
  const bool smooth =
      !started_ || jump <= kSpeedNoiseMS + config_.max_acceleration_m_s2 * std::min(dt_s, 1.0);
  refused_in_a_row_ = smooth ? 0 : refused_in_a_row_ + 1;
  return smooth || refused_in_a_row_ >= kConfirmingSamples;
}

WheelStatus WheelOdometer::add(const WheelSample& sample) {
  if (!plausible_stamp(sample.stamp_ns)) return WheelStatus::kBadTime;
  const double dt_s = started_ ? seconds_between(last_.stamp_ns, sample.stamp_ns) : 0.0;
  if (started_ && dt_s <= 0.0) return WheelStatus::kBadTime;
  if (!plausible(sample, dt_s)) return WheelStatus::kBadValue;
  if (started_ && dt_s <= config_.wheel_timeout_s) {
    rolled_m_ += 0.5 * dt_s * (velocity(last_) + velocity(sample));
    turned_rad_ += 0.5 * dt_s * (last_.wz_rad_s + sample.wz_rad_s);
  } else {
    rolled_m_ = taken_m_;  // distance during a gap: unknown, counts as zero
  }
  interval_s_ = started_ ? dt_s : 0.0;
  last_ = sample;
  started_ = true;
  return WheelStatus::kAccepted;
}

bool WheelOdometer::valid(std::int64_t stamp_ns) const {
  return started_ && std::abs(seconds_between(last_.stamp_ns, stamp_ns)) <= config_.wheel_timeout_s;
}

double WheelOdometer::turn_rad(std::int64_t stamp_ns) const {
  return turned_rad_ + (valid(stamp_ns) ? last_.wz_rad_s * seconds_between(last_.stamp_ns, stamp_ns) : 0.0);
}

Eigen::Vector2d WheelOdometer::take_displacement(std::int64_t stamp_ns) {
  if (!valid(stamp_ns)) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d here = rolled_m_ + velocity(last_) * seconds_between(last_.stamp_ns, stamp_ns);
  Eigen::Vector2d displacement = here - taken_m_;
  taken_m_ = here;
  return displacement;
}

}  // namespace isobar

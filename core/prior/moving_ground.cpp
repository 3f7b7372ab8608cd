// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/moving_ground.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {
namespace {

// A younger fork is still too close to the filter to compare.
constexpr double kForkMinAgeS = 0.5;
// Wheels and fork must disagree for this long before the ground counts as moving: longer than a bump.
constexpr double kDisagreementS = 0.08;
// Largest excess of the fork's pressure innovation over the filter's in a ride, where the pressure fits the
// fork and not the wheels. A larger excess is the effect of vibration on the fork.
constexpr double kForkMisfitM = 0.15;
// End of a ride: low-pass of the vertical acceleration, and the value below which it counts as zero.
constexpr double kAccelSmoothingS = 0.3;
constexpr double kQuietAccelMS2 = 0.12;

}  // namespace

void MovingGround::begin() {
  moves_ = true;
  agreeing_s_ = 0.0;
}

void MovingGround::add_acceleration(double accel_m_s2, double dt_s) {
  accel_m_s2_ += (accel_m_s2 - accel_m_s2_) * -std::expm1(-dt_s / kAccelSmoothingS);
}

void MovingGround::add_pressure(double fork_innovation_m, double filter_innovation_m) {
  fork_misfit_m_ = std::abs(fork_innovation_m) - std::abs(filter_innovation_m);
}

MovingGround::Event MovingGround::add_climb(const WheelClimb& wheels, const FilterForks& forks,
                                            const VerticalFilter& filter) {
  return moves_ ? watch_end(wheels, filter) : watch_start(wheels, forks);
}

MovingGround::Event MovingGround::watch_start(const WheelClimb& wheels, const FilterForks& forks) {
  if (forks.age_s() < kForkMinAgeS) return Event::kNone;
  const auto innovation =
      forks.older().climb_innovation(wheels.climb_m_s, wheels.forward_m_s, wheels.speed_variance);
  const double limit =
      std::max(config_.moving_ground_speed_m_s, config_.moving_ground_sigma * std::sqrt(innovation.variance));
  disagreeing_s_ = std::abs(innovation.value) > limit ? disagreeing_s_ + wheels.dt_s : 0.0;
  if (disagreeing_s_ < kDisagreementS) return Event::kNone;
  if (fork_misfit_m_ > kForkMisfitM) return Event::kForkWrong;
  begin();
  return Event::kBegins;
}

MovingGround::Event MovingGround::watch_end(const WheelClimb& wheels, const VerticalFilter& filter) {
  const auto innovation =
      filter.climb_innovation(wheels.climb_m_s, wheels.forward_m_s, wheels.speed_variance);
  const double limit = config_.ground_stopped_speed_m_s + 2.0 * std::sqrt(innovation.variance);
  const bool agree = std::abs(innovation.value) < limit && std::abs(accel_m_s2_) < kQuietAccelMS2;
  agreeing_s_ = agree ? agreeing_s_ + wheels.dt_s : 0.0;
  if (agreeing_s_ < config_.ground_stopped_time_s) return Event::kNone;
  moves_ = false;
  return Event::kEnds;
}

}  // namespace isobar

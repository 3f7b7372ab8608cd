// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/pressure_pairs.hpp"

#include <algorithm>

#include "core/stamp.hpp"

namespace isobar {

void PressurePairs::add_base(std::int64_t stamp_ns, double reference_log, double relative_variance) {
  if (waiting_count_ == kWaiting) {
    std::move(waiting_.begin() + 1, waiting_.end(), waiting_.begin());
    --waiting_count_;
  }
  waiting_[waiting_count_++] = {stamp_ns, reference_log, relative_variance};
}

bool PressurePairs::add_robot(std::int64_t stamp_ns, double log_pa, double climb_m, Mean& out) {
  robot_.add(stamp_ns, log_pa, climb_m);
  ++robot_count_;
  // Half a robot sample of tolerance: stamps jitter.
  const double since_s = seconds_between(mean_ns_, stamp_ns);
  if (since_s >= 0.0 && since_s * (1.0 + 0.5 / robot_count_) < kBlockS) return false;
  Mean sum{0.0, 0.0, 0.0, 0.0, 0.0};
  int count = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < waiting_count_; ++i) {
    const Sample& base = waiting_[i];
    if (!robot_.reaches(base.stamp_ns)) {
      waiting_[kept++] = base;
      continue;
    }
    if (!robot_.remembers(base.stamp_ns)) continue;  // older than the robot's first sample
    const RobotAir::Value robot = robot_.at(base.stamp_ns);
    sum.difference_log += base.reference_log - robot.log_pa;
    sum.climb_m += robot.climb_m;
    sum.robot_share += robot.noise_share;
    sum.base_variance += base.relative_variance;
    sum.delay_s += seconds_between(base.stamp_ns, stamp_ns);
    ++count;
  }
  waiting_count_ = kept;
  if (count == 0) return false;
  out = {sum.difference_log / count, sum.climb_m / count, robot_share(sum.robot_share / count, count),
         sum.base_variance / (count * count), sum.delay_s / count};
  mean_ns_ = stamp_ns;
  robot_count_ = 0;
  return true;
}

// Neighbouring interpolations share a robot sample: inner samples have weight 1 together, the two at the ends that of
// a single interpolation, `end_share`.
double PressurePairs::robot_share(double end_share, int base_count) const {
  const double samples = std::min(base_count, robot_count_);
  return (samples - 1.0 + end_share) / (samples * samples);
}

}  // namespace isobar

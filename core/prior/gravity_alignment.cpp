// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/gravity_alignment.hpp"

#include "core/so3.hpp"

namespace isobar {
namespace {

// A robot's mean specific force is gravity within a third: anything else is another unit (g) or a broken
// sensor, and would tilt the map.
constexpr double kLeastGravityMS2 = 6.5;
constexpr double kMostGravityMS2 = 13.0;

}  // namespace

GravityAlignment::Status GravityAlignment::add(const Eigen::Vector3d& turn_rad,
                                               const Eigen::Vector3d& force_m_s2, double dt_s) {
  force_sum_ = exp_so3(turn_rad).conjugate() * force_sum_ + force_m_s2;
  elapsed_s_ += dt_s;
  ++samples_;
  if (elapsed_s_ < duration_s_) return Status::kSumming;
  const double mean_m_s2 = force_sum_.norm() / samples_;
  if (mean_m_s2 >= kLeastGravityMS2 && mean_m_s2 <= kMostGravityMS2) return Status::kAligned;
  restart();
  return Status::kWrongGravity;
}

void GravityAlignment::restart() {
  force_sum_.setZero();
  elapsed_s_ = 0.0;
  samples_ = 0;
}

}  // namespace isobar

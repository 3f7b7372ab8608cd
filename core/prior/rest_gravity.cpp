// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/rest_gravity.hpp"

#include <algorithm>

#include "core/samples.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Least scatter of a gyro's means [rad/s]: its wander within a minute.
constexpr double kLeastRateSigmaRadS = 3e-4;
// Correlation of a swing's angle, in windows: half a period.
constexpr double kSwingWindows = 5.0;

}  // namespace

void RestGravity::Scatter::add(const Eigen::Vector3d& value, int count) {
  const Eigen::Vector3d before = value - mean;
  mean += before / count;
  square_sum += before.cwiseProduct(value - mean);
}

bool RestGravity::add(const StandstillDetector::Rest& rest, bool on_wheels, Measurement& out) {
  ++windows_;
  rate_rad_s_.add(rest.gyro_rad_s, windows_);
  force_m_s2_.add(rest.force_m_s2, windows_);
  out.variance = std::max(rest.force_variance, force_m_s2_.variance(windows_));
  if (on_wheels) return true;
  if (windows_ < kLeastWindows) return false;
  out.rate_variance = kSwingWindows * (squared(kLeastRateSigmaRadS) + rate_rad_s_.variance(windows_));
  out.variance += squared(kGravity / kSlowestSwingRadS) * out.rate_variance;
  return true;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/mount_doubt.hpp"

#include <algorithm>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Weight of what is known of hands before any evidence, in angles found.
constexpr double kPriorWeight = 0.5;

}  // namespace

void MountDoubt::learn(const MountEstimate& found, bool tilt_shown) {
  variance_rad2_ = yaw_rad2_ = prior_rad2_;
  if (found.verdict == MountVerdict::kInconsistent) return;
  constexpr double kUnknownRad2 = squared(MountFilterConfig{}.mount_sigma_rad);
  double sum_rad2 = kPriorWeight * prior_rad2_;
  double weight = kPriorWeight;
  for (int angle = tilt_shown ? 0 : 2; angle < 3; ++angle) {
    const double share = std::clamp(1.0 - found.covariance_rad2(angle, angle) / kUnknownRad2, 0.0, 1.0);
    // The yaw is that against the wheels' straight drives, which are base_link.
    const double mounts = angle < 2 ? 2.0 : 1.0;
    sum_rad2 += share * squared(found.error_rad[angle]) / mounts;
    weight += share;
  }
  variance_rad2_ = sum_rad2 / weight;
  if (!found.yaw_found) {
    yaw_rad2_ = variance_rad2_;
    return;
  }
  yaw_rad2_ = squared(found.error_rad.z()) + std::min(found.covariance_rad2(2, 2), variance_rad2_);
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/second_session.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "run/evaluation/association.hpp"

namespace isobar::evaluation {

SecondSessionError second_session_error(const Session& first, const Session& second) {
  const auto pairs_before = associate(first.reference, first.estimate);
  std::vector<PosePair> pairs = associate(second.reference, second.estimate);
  SecondSessionError error;
  if (pairs_before.empty() || pairs.empty()) return error;
  apply_transform(pairs, alignment_transform(pairs_before, Alignment::kYawTranslation));
  for (const PosePair& pair : pairs) {
    const double apart_m = (pair.estimate.position_m - pair.reference.position_m).norm();
    const double turn_rad =
        std::abs(wrap_angle_rad(yaw_rad(pair.estimate.attitude) - yaw_rad(pair.reference.attitude)));
    error.position_rms_m += apart_m * apart_m;
    error.yaw_rms_rad += turn_rad * turn_rad;
    error.position_max_m = std::max(error.position_max_m, apart_m);
    error.yaw_max_rad = std::max(error.yaw_max_rad, turn_rad);
  }
  error.poses = pairs.size();
  error.position_rms_m = std::sqrt(error.position_rms_m / static_cast<double>(error.poses));
  error.yaw_rms_rad = std::sqrt(error.yaw_rms_rad / static_cast<double>(error.poses));
  return error;
}

}  // namespace isobar::evaluation

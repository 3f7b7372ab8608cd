// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_start.hpp"

#include <cmath>

#include "core/stamp.hpp"

namespace isobar {
namespace {

/// Height of the prior at the time of the pose. The datum is up to a write interval younger.
double height_at_pose_m(const files::Checkpoint& checkpoint) {
  constexpr double kLongestS = 1.0;  // datum of a silent IMU
  const HeightDatum& datum = checkpoint.datum;
  const double younger_s = seconds_between(checkpoint.stamp_ns, datum.stamp_ns);
  return datum.height_m - (std::abs(younger_s) < kLongestS ? younger_s * datum.climb_m_s : 0.0);
}

}  // namespace

RunStart continuation_of(const files::Checkpoint& checkpoint) {
  const KnownPlace place{.session = checkpoint.session,
                         .stamp_ns = checkpoint.stamp_ns,
                         .T_map_base = checkpoint.T_map_base,
                         .overlap = checkpoint.overlap,
                         .residual_rms_m = checkpoint.residual_rms_m,
                         .has_height = checkpoint.datum.known,
                         .height_m = height_at_pose_m(checkpoint),
                         .v_map_m_s = checkpoint.v_map_m_s,
                         .yaw_rate_rad_s = checkpoint.yaw_rate_rad_s};
  return {.session = checkpoint.session, .place = place, .datum = checkpoint.datum};
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/encoder/kinematics.hpp"

#include <numbers>

namespace isobar::encoder {

double count_m(const Geometry& geometry) noexcept {
  return 2.0 * std::numbers::pi * geometry.wheel_radius_m / geometry.counts_per_turn;
}

double effective_track_m(const Geometry& geometry) noexcept {
  return geometry.track_width_m * (geometry.drive == Drive::kDifferential ? 1.0 : geometry.track_factor);
}

WheelSample twist(const Geometry& geometry, double left_counts, double right_counts, double dt_s) noexcept {
  const double way_m = count_m(geometry);
  WheelSample sample;
  sample.vx_m_s = 0.5 * (right_counts + left_counts) * way_m / dt_s;
  sample.wz_rad_s = (right_counts - left_counts) * way_m / (effective_track_m(geometry) * dt_s);
  return sample;
}

}  // namespace isobar::encoder

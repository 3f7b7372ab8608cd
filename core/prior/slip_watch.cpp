// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/slip_watch.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {

void SlipWatch::add_rates(double gyro_rad_s, double wheels_rad_s, double dt_s) noexcept {
  elapsed_s_ += dt_s;
  difference_rad_ += (wheels_rad_s - gyro_rad_s) * dt_s;
  gyro_way_rad_ += std::abs(gyro_rad_s) * dt_s;
  wheels_way_rad_ += std::abs(wheels_rad_s) * dt_s;
}

SlipWatch::Slip SlipWatch::take() noexcept {
  if (elapsed_s_ < kWindowS) return {};
  const double way_rad = std::max(gyro_way_rad_, wheels_way_rad_);
  const Slip slip{std::abs(difference_rad_) > kLeastTurnRad + kTurnShare * way_rad,
                  refused_s_ > kRefusedShare * elapsed_s_};
  restart();
  return slip;
}

}  // namespace isobar

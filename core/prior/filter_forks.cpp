// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/filter_forks.hpp"

#include <algorithm>

namespace isobar {

void FilterForks::restart(const VerticalFilter& filter) {
  for (Fork& fork : forks_) fork = {filter, 0.0};
}

void FilterForks::predict(const VerticalFilter& filter, double up_accel_m_s2, double dt_s,
                          double accel_density, bool weather_moves) {
  for (Fork& fork : forks_) {
    fork.filter.predict(up_accel_m_s2, dt_s, accel_density, weather_moves);
    fork.age_s += dt_s;
  }
  const std::size_t older = oldest();
  if (forks_[older].age_s < kLifeS) return;
  forks_[older] = {filter, 0.0};
  // Half a lifetime at most staggers the two, which restart() had made of one age.
  Fork& other = forks_[1 - older];
  other.age_s = std::min(other.age_s, 0.5 * kLifeS);
}

}  // namespace isobar

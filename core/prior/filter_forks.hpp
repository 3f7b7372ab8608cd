// SPDX-License-Identifier: BSD-3-Clause
// Copies of the vertical filter that neither wheels nor pressure have touched for some seconds.
#pragma once

#include <array>
#include <cstddef>

#include "core/prior/vertical_filter.hpp"

namespace isobar {

/// Two forks (copies) of a VerticalFilter, predicted from the acceleration alone. They are split off in turn, so that one
/// of them always predates what the wheels or the pressure have just got wrong: a ride, a door.
class FilterForks {
 public:
  /// Lifetime of a fork [s]: longer ones drift with the accelerometer, shorter ones hold the start of a slow ride.
  static constexpr double kLifeS = 3.0;

  explicit FilterForks(const HeightConfig& config)
      : forks_{Fork{VerticalFilter(config)}, Fork{VerticalFilter(config)}} {}

  /// Splits both off from `filter` now.
  void restart(const VerticalFilter& filter);
  /// VerticalFilter::predict() of both; one that has reached kLifeS is split off from `filter` again.
  void predict(const VerticalFilter& filter, double up_accel_m_s2, double dt_s, double accel_density,
               bool weather_moves);
  /// Calls `change` with both filters: what becomes of them is no measurement.
  template <typename Change>
  void apply(const Change& change) {
    for (Fork& fork : forks_) change(fork.filter);
  }

  /// The older fork; after the first kLifeS its age is 50 to 100 % of that.
  [[nodiscard]] const VerticalFilter& older() const { return forks_[oldest()].filter; }
  [[nodiscard]] double age_s() const { return forks_[oldest()].age_s; }

 private:
  struct Fork {
    VerticalFilter filter;
    double age_s = 0.0;
  };

  [[nodiscard]] std::size_t oldest() const { return forks_[0].age_s >= forks_[1].age_s ? 0 : 1; }

  std::array<Fork, 2> forks_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// A "base station" that rides the elevator while the "robot" stands: the two barometers are swapped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/contradictions/finding.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Means of the pressure over a second, for two hours; later samples are ignored. Allocates in its constructor only.
class PressureSeconds {
 public:
  static constexpr std::size_t kCapacity = 7200;
  PressureSeconds() { cells_.reserve(kCapacity); }
  void add(const PressureSample& sample);
  [[nodiscard]] std::int64_t first() const { return first_; }
  [[nodiscard]] std::int64_t end() const { return first_ + static_cast<std::int64_t>(cells_.size()); }
  /// Mean over `count` seconds from `second` on [Pa]; nothing where one of them has no sample.
  [[nodiscard]] std::optional<double> mean_pa(std::int64_t second, int count) const;

 private:
  struct Cell {
    double sum_pa = 0.0;
    int samples = 0;
  };
  std::vector<Cell> cells_;
  std::int64_t first_ = 0;
};

/// Compares the means of five seconds, half a minute apart. Weather changes by 0.05 Pa/s at most, 1.5 Pa in that time, a
/// door by some pascals for a moment; a floor is 36 Pa. Swapped: the base moves by 36 Pa or more while the robot
/// keeps within a fifth of that, in five windows or more, and never the other way round.
std::optional<Finding> find_swapped_barometers(const PressureSeconds& robot, const PressureSeconds& base);

}  // namespace isobar

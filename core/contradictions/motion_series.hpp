// SPDX-License-Identifier: BSD-3-Clause
// Motion of the robot on a plane by one sensor, on a grid of time that all sensors share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace isobar {

/// Motion over some time, in axes of base_link.
struct PlanarStep {
  double turn_rad = 0.0;
  double x_m = 0.0;  ///< of the accelerometer: change of speed [m/s], as y
  double y_m = 0.0;
};

/// Sum over a window.
struct PlanarSum {
  PlanarStep step;
  bool turn_known = false;  ///< over the whole window, as the next
  bool way_known = false;
};

/// Steps in cells of 0.1 s by the sensor's own stamps, for 20 minutes; later ones are ignored. Allocates in its
/// constructor only.
class MotionSeries {
 public:
  static constexpr std::int64_t kCellNs = 100'000'000;
  static constexpr std::size_t kCapacity = 12'000;
  /// Longest time between two samples of a rate that counts as known.
  static constexpr std::int64_t kLongestGapNs = 300'000'000;

  MotionSeries() { cells_.reserve(kCapacity); }

  /// Motion from one stamp to another, spread evenly over the cells between. Steps come in order of time; one that
  /// goes back, or lasts longer than kLongestGapNs, is ignored.
  void add_step(std::int64_t from_ns, std::int64_t to_ns, const PlanarStep& step, bool way_known);
  /// A sample of the rates: trapezoid since the sample before.
  void add_rate(std::int64_t stamp_ns, const PlanarStep& rate_per_s);

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] bool full() const { return cells_.size() == kCapacity; }
  /// Number of the first cell since the epoch, and that after the last.
  [[nodiscard]] std::int64_t first() const { return first_; }
  [[nodiscard]] std::int64_t end() const { return first_ + static_cast<std::int64_t>(cells_.size()); }
  [[nodiscard]] bool turn_known(std::int64_t cell) const;
  [[nodiscard]] double turn_rad(std::int64_t cell) const { return at(cell).turn_rad; }
  /// Sum over `count` cells from `cell` on.
  [[nodiscard]] PlanarSum sum(std::int64_t cell, int count) const;

 private:
  struct Cell {
    float turn_rad = 0.0F;
    float x_m = 0.0F;
    float y_m = 0.0F;
    float turn_s = 0.0F;  // time for which the turn is known, as the next
    float way_s = 0.0F;
  };
  [[nodiscard]] const Cell& at(std::int64_t cell) const {
    return cells_[static_cast<std::size_t>(cell - first_)];
  }

  std::vector<Cell> cells_;
  std::int64_t first_ = 0;
  std::int64_t last_ns_ = 0;
  PlanarStep last_rate_;
  bool has_rate_ = false;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Smooth functions of time from equidistant raw samples.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace isobar::simulation {

/// Weights of the six samples that define a uniform quintic B-spline at one time, and of its first two
/// derivatives.
struct SplineWeights {
  std::size_t first = 0;  ///< index of the first of the six samples
  std::array<double, 6> value{};
  std::array<double, 6> rate{};   ///< 1/s
  std::array<double, 6> curve{};  ///< 1/s^2
};

/// Time grid common to all channels of a scenario. The raw samples are the control points of a uniform
/// quintic B-spline (de Boor, "A Practical Guide to Splines"): every channel is four times continuously
/// differentiable with exact derivatives, and linear relations between channels are preserved.
class SplineGrid {
 public:
  /// Spacing of the raw samples: passes motion up to about 5 Hz and rounds corners over 0.2 s.
  static constexpr double kStepS = 0.05;

  /// Weights at `time_s` since the first sample, clamped to the grid of `samples` samples.
  [[nodiscard]] static SplineWeights weights(double time_s, std::size_t samples);
};

/// Scalar function of time on the grid, in any unit.
class Channel {
 public:
  Channel() = default;
  explicit Channel(std::vector<double> samples) : samples_(std::move(samples)) {}

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] double at(double time_s) const { return value(SplineGrid::weights(time_s, samples_.size())); }
  [[nodiscard]] double value(const SplineWeights& weights) const { return sum(weights.first, weights.value); }
  [[nodiscard]] double rate(const SplineWeights& weights) const { return sum(weights.first, weights.rate); }
  [[nodiscard]] double curve(const SplineWeights& weights) const { return sum(weights.first, weights.curve); }

 private:
  [[nodiscard]] double sum(std::size_t first, const std::array<double, 6>& weights) const {
    double total = 0.0;
    for (std::size_t i = 0; i < 6; ++i) total += weights[i] * samples_[first + i];
    return total;
  }

  std::vector<double> samples_;
};

}  // namespace isobar::simulation

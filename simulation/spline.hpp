// SPDX-License-Identifier: BSD-3-Clause
// Smooth functions of time from evenly spaced raw samples.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace isobar::simulation {

/// Weights of the six samples that a quintic uniform B-spline sees at one time, with two derivatives.
struct SplineWeights {
  std::size_t first = 0;  ///< index of the first of the six samples
  std::array<double, 6> value{};
  std::array<double, 6> rate{};   ///< 1/s
  std::array<double, 6> curve{};  ///< 1/s^2
};

/// Time grid shared by all channels of a scenario. The raw samples are the control points of a uniform
/// quintic B-spline (de Boor, "A Practical Guide to Splines"), so every channel is four times continuously
/// differentiable and its derivatives are exact. A linear relation between channels survives.
class SplineGrid {
 public:
  /// Spacing of the raw samples. 50 ms lets motion up to some 5 Hz through and rounds corners over 0.2 s.
  static constexpr double kStepS = 0.05;

  /// Weights at time_s since the first sample, held inside the grid of `samples` samples.
  [[nodiscard]] static SplineWeights weights(double time_s, std::size_t samples);
};

/// One scalar function of time [any unit], sampled on the grid.
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

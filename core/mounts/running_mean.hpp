// SPDX-License-Identifier: BSD-3-Clause
// Mean of independent measurements of one constant, robust against outliers. Welford's recursion, whose new values
// are clipped at three standard deviations.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/squared.hpp"

namespace isobar {

class RunningMean {
 public:
  /// `least_sigma`: smallest standard deviation of one measurement, for the first ones.
  explicit RunningMean(double least_sigma) : least_sigma_(least_sigma) {}

  void add(double value) {
    ++count_;
    if (count_ > kClipFrom) {
      value = std::clamp(value, mean_ - kClipSigmas * sigma(), mean_ + kClipSigmas * sigma());
    }
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (value - mean_);
  }

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }
  /// Standard deviation of one measurement.
  [[nodiscard]] double sigma() const {
    if (count_ < 2) return least_sigma_;
    return std::max(least_sigma_, std::sqrt(squares_ / static_cast<double>(count_ - 1)));
  }
  /// Standard deviation of the mean; infinite before the first measurement.
  [[nodiscard]] double sigma_of_mean() const {
    if (count_ == 0) return std::numeric_limits<double>::infinity();
    return sigma() / std::sqrt(static_cast<double>(count_));
  }

 private:
  static constexpr std::uint32_t kClipFrom = 5;
  static constexpr double kClipSigmas = 3.0;

  double least_sigma_;
  double mean_ = 0.0;
  double squares_ = 0.0;
  std::uint32_t count_ = 0;
};

}  // namespace isobar

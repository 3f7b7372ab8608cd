// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/point_to_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isobar {

namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;

// 1.4826 times the median of absolute values is the standard deviation of a normal distribution.
constexpr float kDeviationPerMedian = 1.4826F;
constexpr float kLossPerDeviation = 3.0F;

// Variance of a residual in units of the noise's: 1 where the fixed directions are not felt.
float relative_variance(const Vector6f& jacobian, const PairNoise& noise) {
  return 1.0F + jacobian.cwiseAbs2().dot(noise.fixed_variance) / (noise.noise_m * noise.noise_m);
}

}  // namespace

float residual_scale_m(std::span<const Pair> pairs, const PairNoise& noise, float largest_m) {
  constexpr std::size_t kBins = 128;
  std::array<float, kBins> histogram{};
  const float bins_per_m = kBins / largest_m;
  float total = 0.0F;
  for (const Pair& pair : pairs) {
    const Vector6f jacobian = point_to_plane_jacobian(pair);
    const float error = std::abs(pair.residual_m) / std::sqrt(relative_variance(jacobian, noise));
    // A floor says nothing to a solver that cannot move up: neither do its residuals.
    const float share = jacobian.tail<3>().cwiseAbs2().dot(noise.free.tail<3>());
    const auto bin = static_cast<std::size_t>(std::min(error * bins_per_m, static_cast<float>(kBins - 1)));
    histogram[bin] += share;
    total += share;
  }
  float below = 0.0F;
  std::size_t bin = 0;
  while (bin + 1 < kBins && below + histogram[bin] < 0.5F * total) {
    below += histogram[bin++];
  }
  const float inside = histogram[bin] > 0.0F ? (0.5F * total - below) / histogram[bin] : 0.5F;
  const float median = (static_cast<float>(bin) + inside) / bins_per_m;
  return std::clamp(kDeviationPerMedian * median, noise.noise_m, std::max(largest_m, noise.noise_m));
}

NormalEquations accumulate(std::span<const Pair> pairs, const PairNoise& noise, float scale_m) {
  NormalEquations sum;
  const float c2 = kLossPerDeviation * scale_m * kLossPerDeviation * scale_m;
  for (const Pair& pair : pairs) {
    const Vector6f jacobian = point_to_plane_jacobian(pair);
    const float variance = relative_variance(jacobian, noise);
    const float error2 = pair.residual_m * pair.residual_m;
    const float loss = 1.0F + error2 / (variance * c2);
    const float weight = 1.0F / (loss * loss * variance);
    const Vector6d j = jacobian.cast<double>();
    const double w = weight;
    sum.hessian.selfadjointView<Eigen::Lower>().rankUpdate(j, w);
    sum.gradient += w * pair.residual_m * j;
    sum.weight_sum += w;
    sum.squared_error_sum += w * error2;
    sum.squared_lever_sum += w * pair.p_robot.squaredNorm();
  }
  sum.hessian = sum.hessian.selfadjointView<Eigen::Lower>();
  return sum;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/spline.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::simulation {

namespace {

// Basis of the uniform quintic B-spline on [0, 1): 120 * N_i(u) = sum_k kBasis[i][k] u^k.
constexpr double kBasis[6][6] = {  // NOLINT(modernize-avoid-c-arrays): a table
    {1, -5, 10, -10, 5, -1},    {26, -50, 20, 20, -20, 5}, {66, 0, -60, 0, 30, -10},
    {26, 50, 20, -20, -20, 10}, {1, 5, 10, 10, 5, -5},     {0, 0, 0, 0, 0, 1}};

}  // namespace

SplineWeights SplineGrid::weights(double time_s, std::size_t samples) {
  // Between grid points i and i + 1 the spline depends on the six control points i - 2 … i + 3.
  const double position = std::clamp(time_s / kStepS, 2.0, static_cast<double>(samples) - 4.0);
  const double whole = std::floor(position);
  const double u = position - whole;
  SplineWeights weights;
  weights.first = static_cast<std::size_t>(whole) - 2;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& c = kBasis[i];
    weights.value[i] = (c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))))) / 120.0;
    weights.rate[i] =
        (c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5])))) / (120.0 * kStepS);
    weights.curve[i] =
        (2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * 20 * c[5]))) / (120.0 * kStepS * kStepS);
  }
  return weights;
}

}  // namespace isobar::simulation

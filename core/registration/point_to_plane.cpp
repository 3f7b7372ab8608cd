// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/point_to_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isobar {

namespace {

// Structure of arrays: chunks of 64 pairs, one row each, so that operations run down columns with SIMD. Sums
// within a chunk are in single precision (64 addends lose 4e-6 at most), over chunks in double.
constexpr int kChunk = 64;
using Column = Eigen::Array<float, kChunk, 1>;

// Standard deviation of a normal distribution over the median of its absolute values.
constexpr float kDeviationPerMedian = 1.4826F;
// Width c of the loss: residuals beyond three standard deviations are outliers.
constexpr float kLossPerDeviation = 3.0F;

struct Chunk {
  Eigen::Array<float, kChunk, 6> jacobian;
  Eigen::Array<float, kChunk, 3> p;
  Column residual_m;
  Column squared_lever_m2;
  Column variance;  // of a residual over noise_m^2: 1 where it does not depend on pose_variance
  int count = 0;    // rows in use; the others are zero
};

void load(std::span<const Pair> pairs, const PairNoise& noise, Chunk& chunk) {
  Eigen::Array<float, kChunk, 3>& p = chunk.p;
  chunk.count = static_cast<int>(pairs.size());
  if (chunk.count < kChunk) {
    p.setZero();
    chunk.jacobian.setZero();
    chunk.residual_m.setZero();
  }
  for (int i = 0; i < chunk.count; ++i) {
    const Pair& pair = pairs[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      p(i, axis) = pair.p_robot[axis];
      chunk.jacobian(i, 3 + axis) = pair.normal[axis];
    }
    chunk.residual_m[i] = pair.residual_m;
  }
  // J = (p x n, n), column by column.
  const auto n = chunk.jacobian.rightCols<3>();
  chunk.jacobian.col(0) = p.col(1) * n.col(2) - p.col(2) * n.col(1);
  chunk.jacobian.col(1) = p.col(2) * n.col(0) - p.col(0) * n.col(2);
  chunk.jacobian.col(2) = p.col(0) * n.col(1) - p.col(1) * n.col(0);
  chunk.squared_lever_m2 = p.col(0).square() + p.col(1).square() + p.col(2).square();
  chunk.variance.setOnes();
  for (int k = 0; k < 6; ++k) {
    const float relative = noise.pose_variance[k] / (noise.noise_m * noise.noise_m);
    if (relative > 0.0F) {
      chunk.variance += relative * chunk.jacobian.col(k).square();
    }
  }
}

// Calls `use(chunk)` for all pairs.
template <typename Use>
void for_each_chunk(std::span<const Pair> pairs, const PairNoise& noise, Use&& use) {
  Chunk chunk;
  for (std::size_t done = 0; done < pairs.size(); done += kChunk) {
    load(pairs.subspan(done, std::min<std::size_t>(kChunk, pairs.size() - done)), noise, chunk);
    use(chunk);
  }
}

}  // namespace

float residual_scale_m(std::span<const Pair> pairs, const PairNoise& noise, float largest_m) {
  constexpr std::size_t kBins = 128;
  std::array<float, kBins> histogram{};
  const float bins_per_m = kBins / largest_m;
  float total = 0.0F;
  for_each_chunk(pairs, noise, [&](const Chunk& chunk) {
    const Column bins =
        (chunk.residual_m.abs() / chunk.variance.sqrt() * bins_per_m).min(static_cast<float>(kBins - 1));
    // Weight by the normal's free part: where z is fixed, a floor's residuals carry no information.
    const Column share = chunk.jacobian.col(3).square() * noise.free[3] +
                         chunk.jacobian.col(4).square() * noise.free[4] +
                         chunk.jacobian.col(5).square() * noise.free[5];
    for (int i = 0; i < chunk.count; ++i) {
      histogram[static_cast<std::size_t>(bins[i])] += share[i];
    }
    total += share.sum();
  });
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
  for_each_chunk(pairs, noise, [&](const Chunk& chunk) {
    const Column squared_error = chunk.residual_m.square();
    const Column loss = 1.0F + squared_error / (chunk.variance * c2);
    Column weight = (loss.square() * chunk.variance).inverse();
    weight.tail(kChunk - chunk.count).setZero();
    for (int row = 0; row < 6; ++row) {
      const Column weighted = weight * chunk.jacobian.col(row);
      sum.gradient(row) += (weighted * chunk.residual_m).sum();
      for (int col = 0; col <= row; ++col) {
        sum.hessian(row, col) += (weighted * chunk.jacobian.col(col)).sum();
      }
    }
    sum.weight_sum += weight.sum();
    sum.squared_error_sum += (weight * squared_error).sum();
    sum.squared_lever_sum += (weight * chunk.squared_lever_m2).sum();
    for (int row = 0; row < 3; ++row) {
      const Column weighted = weight * chunk.p.col(row);
      sum.lever_sum(row) += weighted.sum();
      for (int col = 0; col <= row; ++col)
        sum.lever_square_sum(row, col) += (weighted * chunk.p.col(col)).sum();
    }
  });
  sum.lever_square_sum = sum.lever_square_sum.selfadjointView<Eigen::Lower>();
  sum.hessian = sum.hessian.selfadjointView<Eigen::Lower>();
  return sum;
}

}  // namespace isobar

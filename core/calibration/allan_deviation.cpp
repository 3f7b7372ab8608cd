// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/allan_deviation.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace isobar {
namespace {

constexpr int kParts = 4;  // white, bias instability, walk, ramp
// Points with a larger relative uncertainty are ignored: fewer than three independent clusters.
constexpr double kUselessUncertainty = 0.5;

using Parts = Eigen::Vector4d;  // squared coefficients

/// Regressors: contribution of each squared coefficient to the squared deviation.
Parts regressors(const AllanPoint& point) {
  const auto m = static_cast<double>(point.samples);
  const double tau_s = point.tau_s;
  return {1.0 / tau_s, 2.0 * std::numbers::ln2 / std::numbers::pi,
          tau_s / m * (2.0 * m * m + 1.0) / (6.0 * m), 0.5 * tau_s * tau_s};
}

/// Non-negative least squares by exhaustive search over the 15 active sets.
Parts fit_non_negative(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Parts best = Parts::Zero();
  double least = b.squaredNorm();
  for (unsigned mask = 1; mask < (1U << kParts); ++mask) {
    std::vector<int> chosen;
    for (int part = 0; part < kParts; ++part) {
      if ((mask & (1U << static_cast<unsigned>(part))) != 0) chosen.push_back(part);
    }
    if (static_cast<Eigen::Index>(chosen.size()) > A.rows()) continue;
    const Eigen::MatrixXd active = A(Eigen::all, chosen);
    const Eigen::VectorXd x = active.colPivHouseholderQr().solve(b);
    const double rest = (active * x - b).squaredNorm();
    if (!x.allFinite() || x.minCoeff() < 0.0 || !(rest < least)) continue;
    least = rest;
    best.setZero();
    for (std::size_t i = 0; i < chosen.size(); ++i) best[chosen[i]] = x[static_cast<Eigen::Index>(i)];
  }
  return best;
}

}  // namespace

std::vector<AllanPoint> overlapping_allan(std::span<const double> values, double dt_s, int per_decade) {
  const std::size_t count = values.size();
  std::vector<AllanPoint> points;
  if (count < 2) return points;
  // Cumulative sums of the deviations from the mean: sums of 1e5 Pa would lose the significant digits.
  std::vector<double> sums(count + 1, 0.0);
  double mean = 0.0;
  for (std::size_t i = 0; i < count; ++i) mean += (values[i] - mean) / static_cast<double>(i + 1);
  for (std::size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + (values[i] - mean);
  const double factor = std::pow(10.0, 1.0 / std::max(per_decade, 1));
  double wanted = 1.0;
  for (std::size_t m = 1; 2 * m <= count;) {
    double squares = 0.0;
    const std::size_t pairs = count - 2 * m + 1;
    for (std::size_t j = 0; j < pairs; ++j) {
      const double difference = sums[j + 2 * m] - 2.0 * sums[j + m] + sums[j];
      squares += difference * difference;
    }
    const auto length = static_cast<double>(m);
    const double clusters = static_cast<double>(count) / length;
    points.push_back({m, length * dt_s, std::sqrt(0.5 * squares / static_cast<double>(pairs)) / length,
                      1.0 / std::sqrt(2.0 * (clusters - 1.0))});
    while (static_cast<std::size_t>(std::llround(wanted)) <= m) wanted *= factor;
    m = static_cast<std::size_t>(std::llround(wanted));
  }
  return points;
}

AllanNoise identify_noise(std::span<const AllanPoint> points) {
  std::vector<AllanPoint> useful;
  for (const AllanPoint& point : points) {
    if (point.uncertainty <= kUselessUncertainty && point.deviation > 0.0) useful.push_back(point);
  }
  if (useful.empty()) return {};
  const auto rows = static_cast<Eigen::Index>(useful.size());
  Eigen::MatrixXd A(rows, kParts);
  Eigen::VectorXd b(rows);
  // Weighted by the relative uncertainty of the squared deviation, 2 u.
  for (Eigen::Index i = 0; i < rows; ++i) {
    const AllanPoint& point = useful[static_cast<std::size_t>(i)];
    const double variance = point.deviation * point.deviation;
    const double weight = 1.0 / (2.0 * point.uncertainty * variance);
    A.row(i) = weight * regressors(point).transpose();
    b[i] = weight * variance;
  }
  const Parts squared = fit_non_negative(A, b);
  return {std::sqrt(squared[0]), std::sqrt(squared[1]), std::sqrt(squared[2]), std::sqrt(squared[3])};
}

double modelled_deviation(const AllanNoise& noise, const AllanPoint& point) {
  const Parts squared(noise.white * noise.white, noise.bias_instability * noise.bias_instability,
                      noise.walk * noise.walk, noise.ramp * noise.ramp);
  return std::sqrt(regressors(point).dot(squared));
}

}  // namespace isobar

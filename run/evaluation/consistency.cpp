// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/so3.hpp"

namespace isobar::evaluation {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using CovarianceMatrix = Eigen::Matrix<double, 6, 6>;

// 95 % quantiles of the chi-squared distribution with 1, 3 and 6 degrees of freedom.
constexpr double kQuantile1 = 3.841459;
constexpr double kQuantile3 = 7.814728;
constexpr double kQuantile6 = 12.591587;
// The same of 99.99 % with 3 degrees of freedom.
constexpr double kQuantile3Rare = 21.107513;

// Variance that the files cannot resolve, 1 um and 1 urad: a claim to know better has no meaning.
constexpr double kResolutionVariance = 1e-12;

Vector6d error_of(const PosePair& pair) {
  Vector6d error;
  error.head<3>() = pair.estimate.position_m - pair.reference.position_m;
  error.tail<3>() = log_so3((pair.estimate.attitude * pair.reference.attitude.conjugate()).normalized());
  return error;
}

/// Normalised error squared; infinite where the covariance is not positive definite.
template <int Size>
double normalised(const Eigen::Matrix<double, Size, 1>& error,
                  const Eigen::Matrix<double, Size, Size>& covariance) {
  const Eigen::LLT<Eigen::Matrix<double, Size, Size>> factor(covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return factor.matrixL().solve(error).squaredNorm();
}

/// Counts of one run.
struct Counts {
  std::size_t poses = 0;
  std::size_t finite = 0;
  double nees_sum = 0.0;
  std::size_t within = 0;
  std::size_t position = 0;
  std::size_t orientation = 0;
  std::array<std::size_t, 6> component{};

  std::int64_t silent_since_ns = -1;  ///< start of the current run of silently wrong poses; -1: none
  double longest_silent_s = 0.0;

  void add_silence(const PoseCovariance& pose, const Vector6d& error, double position_normalised) {
    const bool wrong = pose.registered && error.head<3>().norm() > ConsistencyFigures::kWrongM &&
                       position_normalised > kQuantile3Rare;
    if (!wrong) {
      silent_since_ns = -1;
      return;
    }
    if (silent_since_ns < 0) silent_since_ns = pose.stamp_ns;
    longest_silent_s =
        std::max(longest_silent_s, 1e-9 * static_cast<double>(pose.stamp_ns - silent_since_ns));
  }

  /// `covariance`: of the pose, turned into the reference's frame.
  void add(const PoseCovariance& pose, const Vector6d& error, const CovarianceMatrix& covariance) {
    ++poses;
    const double all = normalised<6>(error, covariance);
    if (std::isfinite(all)) {
      ++finite;
      nees_sum += all;
    }
    if (all <= kQuantile6) ++within;
    const double of_position = normalised<3>(error.head<3>(), covariance.topLeftCorner<3, 3>());
    if (of_position <= kQuantile3) ++position;
    add_silence(pose, error, of_position);
    if (normalised<3>(error.tail<3>(), covariance.bottomRightCorner<3, 3>()) <= kQuantile3) ++orientation;
    for (int i = 0; i < 6; ++i) {
      if (error[i] * error[i] <= kQuantile1 * covariance(i, i)) ++component[static_cast<std::size_t>(i)];
    }
  }

  [[nodiscard]] ConsistencyFigures figures() const {
    ConsistencyFigures figures;
    figures.poses = poses;
    if (poses == 0) return figures;
    const auto share = [&](std::size_t count) {
      return static_cast<double>(count) / static_cast<double>(poses);
    };
    if (finite > 0) figures.nees = nees_sum / (6.0 * static_cast<double>(finite));
    figures.longest_silent_s = longest_silent_s;
    figures.within_95 = share(within);
    figures.within_95_position = share(position);
    figures.within_95_orientation = share(orientation);
    for (std::size_t i = 0; i < component.size(); ++i) figures.within_95_component[i] = share(component[i]);
    return figures;
  }
};

}  // namespace

ConsistencyFigures consistency_of(const std::vector<PosePair>& pairs, std::vector<PoseCovariance> covariances,
                                  const Eigen::Isometry3d& T_reference_estimate) {
  std::sort(covariances.begin(), covariances.end(),
            [](const PoseCovariance& a, const PoseCovariance& b) { return a.stamp_ns < b.stamp_ns; });
  CovarianceMatrix turn = CovarianceMatrix::Zero();
  turn.topLeftCorner<3, 3>() = T_reference_estimate.linear();
  turn.bottomRightCorner<3, 3>() = T_reference_estimate.linear();
  Counts counts;
  auto next = covariances.begin();
  for (const PosePair& pair : pairs) {
    while (next != covariances.end() && next->stamp_ns < pair.estimate.stamp_ns) ++next;
    if (next == covariances.end()) break;
    const CovarianceMatrix& claimed = next->covariance;
    if (next->stamp_ns != pair.estimate.stamp_ns || !claimed.allFinite() || claimed.isZero(0.0)) continue;
    counts.add(*next, error_of(pair),
               turn * claimed * turn.transpose() + kResolutionVariance * CovarianceMatrix::Identity());
  }
  return counts.figures();
}

}  // namespace isobar::evaluation

// SPDX-License-Identifier: BSD-3-Clause
// Consistency of an estimator: whether its errors are as large as its covariance says (Bar-Shalom, Li,
// Kirubarajan 2001, "Estimation with Applications to Tracking and Navigation", section 5.4).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "run/evaluation/association.hpp"

namespace isobar::evaluation {

/// Covariance of a pose: of (x, y, z, roll, pitch, yaw) about the axes of the estimate's frame, in m and rad.
struct PoseCovariance {
  std::int64_t stamp_ns = 0;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  bool registered = true;  ///< the estimator calls the pose a good one
};

/// Figures of a run; NaN: unknown. An honest covariance has shares of 0.95 and a mean of 1.
struct ConsistencyFigures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::size_t poses = 0;  ///< with a reference and a covariance
  /// Mean of the normalised estimation error squared e^T C^-1 e, divided by its expectation, 6.
  double nees = kNone;
  double within_95 = kNone;              ///< share of poses within the 95 % ellipsoid of all six, 0 … 1
  double within_95_position = kNone;     ///< the same of x, y, z
  double within_95_orientation = kNone;  ///< the same of roll, pitch, yaw
  /// Longest time in a row that poses are silently wrong [s]: called registered, off by more than kWrongM in
  /// position, and outside of its 99.99 % ellipsoid.
  double longest_silent_s = kNone;
  static constexpr double kWrongM = 0.3;
  /// Share of poses within 1.96 standard deviations: x, y, z, roll, pitch, yaw.
  std::array<double, 6> within_95_component{kNone, kNone, kNone, kNone, kNone, kNone};
};

/// Errors of aligned pairs against the covariances of exactly their stamps. The error of the attitude is the
/// rotation vector from reference to estimate. Covariances of 0 say that nothing is known yet and are left out.
/// @param T_reference_estimate alignment that moved the pairs; turns the covariances
ConsistencyFigures consistency_of(const std::vector<PosePair>& pairs, std::vector<PoseCovariance> covariances,
                                  const Eigen::Isometry3d& T_reference_estimate);

}  // namespace isobar::evaluation

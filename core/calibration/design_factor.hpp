// SPDX-License-Identifier: BSD-3-Clause
// Incremental least squares for the coefficients of a compensation, in fixed memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "core/altitude/compensation.hpp"

namespace isobar {

/// Simultaneous values of a sensor and a reference.
struct CalibrationPair {
  double reference_pa = 0.0;
  double pressure_pa = 0.0;  ///< of the sensor
  double temperature_c = 0.0;
};

/// Triangular QR factor R of the design matrix: a row u^i v^j per sample, augmented by its correction
/// (reference
/// - sensor). Updated block by block with Householder reflections, which do not square the condition number
/// as normal equations do. The columns of R selected by a mask are the factor of that model, so one pass over
/// the data serves all models; factors of several recordings combine to the factor of their union.
class DesignFactor {
 public:
  explicit DesignFactor(const Compensation::Variables& variables);

  void add(std::span<const CalibrationPair> pairs);
  /// Adds the samples of `other`, which must have the same variables.
  void add(const DesignFactor& other);

  struct Solution {
    Compensation compensation;
    int rank = 0;  ///< below the number of coefficients if the data cannot separate them
    /// Condition number of the design matrix in u and v; infinite if rank-deficient.
    double condition_number = 1.0;
  };

  /// Least-squares coefficients in `mask` (minimum norm if rank-deficient), all others zero. An empty mask
  /// gives the identity.
  [[nodiscard]] Solution solve(CompensationMask mask) const;

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  static constexpr int kColumns = 17;  // sixteen products of powers, and the correction
  void fold(const Eigen::MatrixXd& rows);

  Compensation::Variables variables_;
  Eigen::MatrixXd factor_ = Eigen::MatrixXd::Zero(kColumns, kColumns);
  std::size_t count_ = 0;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Least squares for the coefficients of a compensation, over any number of samples in fixed memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "core/altitude/compensation.hpp"

namespace isobar {

/// A sensor beside a reference at one moment.
struct CalibrationPair {
  double reference_pa = 0.0;
  double pressure_pa = 0.0;  ///< of the sensor
  double temperature_c = 0.0;
};

/// The triangular factor of all samples' rows u^i v^j beside their corrections (reference - sensor).
/// Householder QR of one block after the other gives the factor of the whole, without squaring the condition
/// number as normal equations do; and the columns that a mask names in it are the factor of that model. So
/// one pass over the data serves all models, and factors of recordings add up to that of any choice of them.
class DesignFactor {
 public:
  explicit DesignFactor(const Compensation::Variables& variables);

  void add(std::span<const CalibrationPair> pairs);
  /// `other` must have the same variables.
  void add(const DesignFactor& other);

  struct Solution {
    Compensation compensation;
    int rank = 0;  ///< below the number of coefficients: the data cannot tell some of them apart
    /// Largest over smallest singular value of the design matrix in u and v; infinite where rank is short.
    double condition_number = 1.0;
  };

  /// The coefficients in `mask` that fit best (of least norm where there is a choice); all others zero. An
  /// empty mask gives the sensor as it is.
  [[nodiscard]] Solution solve(CompensationMask mask) const;

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  static constexpr int kColumns = 17;  // sixteen powers, and the correction
  void fold(const Eigen::MatrixXd& rows);

  Compensation::Variables variables_;
  Eigen::MatrixXd factor_ = Eigen::MatrixXd::Zero(kColumns, kColumns);
  std::size_t count_ = 0;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/design_factor.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <bit>
#include <limits>

namespace isobar {
namespace {

// Rows factored at a time: bounds the memory.
constexpr std::size_t kBlockRows = 1024;
// Smallest singular value relative to the largest: below it is rounding error accumulated over a million
// rows.
constexpr double kRankTolerance = 1e-10;

}  // namespace

DesignFactor::DesignFactor(const Compensation::Variables& variables) : variables_(variables) {}

void DesignFactor::fold(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd stacked(factor_.rows() + rows.rows(), kColumns);
  stacked << factor_, rows;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked);
  factor_ = qr.matrixQR().topRows(kColumns).triangularView<Eigen::Upper>();
}

void DesignFactor::add(std::span<const CalibrationPair> pairs) {
  Eigen::MatrixXd rows;
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBlockRows) {
    const auto block = pairs.subspan(begin, std::min(kBlockRows, pairs.size() - begin));
    rows.resize(static_cast<Eigen::Index>(block.size()), kColumns);
    for (std::size_t k = 0; k < block.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const double u = (block[k].pressure_pa - variables_.pressure_centre_pa) / variables_.pressure_scale_pa;
      const double v =
          (block[k].temperature_c - variables_.temperature_centre_c) / variables_.temperature_scale_c;
      double power_of_u = 1.0;
      for (Eigen::Index i = 0; i < 4; ++i, power_of_u *= u) {
        rows.row(row).segment<4>(4 * i) = power_of_u * Eigen::RowVector4d(1.0, v, v * v, v * v * v);
      }
      rows(row, kColumns - 1) = block[k].reference_pa - block[k].pressure_pa;
    }
    fold(rows);
  }
  count_ += pairs.size();
}

void DesignFactor::add(const DesignFactor& other) {
  fold(other.factor_);
  count_ += other.count_;
}

DesignFactor::Solution DesignFactor::solve(CompensationMask mask) const {
  Solution solution;
  Eigen::Matrix4d centred = Eigen::Matrix4d::Zero();
  const int count = std::popcount(mask);
  if (count > 0) {
    Eigen::MatrixXd design(kColumns, count);
    for (int k = 0, column = 0; k < kColumns - 1; ++k) {
      if (((mask >> k) & 1) != 0) design.col(column++) = factor_.col(k);
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(design, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(kRankTolerance);
    const Eigen::VectorXd chosen = svd.solve(factor_.col(kColumns - 1));
    for (int k = 0, column = 0; k < kColumns - 1; ++k) {
      if (((mask >> k) & 1) != 0) centred(k / 4, k % 4) = chosen(column++);
    }
    solution.rank = static_cast<int>(svd.rank());
    solution.condition_number = solution.rank == count
                                    ? svd.singularValues()(0) / svd.singularValues()(count - 1)
                                    : std::numeric_limits<double>::infinity();
  }
  // p_cal = p_raw + correction, with p_raw = centre + scale u.
  centred(0, 0) += variables_.pressure_centre_pa;
  centred(1, 0) += variables_.pressure_scale_pa;
  solution.compensation = Compensation(centred, variables_);
  return solution;
}

}  // namespace isobar

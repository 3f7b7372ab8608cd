// SPDX-License-Identifier: BSD-3-Clause
// Moments of the points of one cell in whole numbers: exact, whatever the order, in 32 bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/map/plane_cell.hpp"

namespace isobar {

struct CellMoments;

/// Sum of the moments of cells around one, about its centre, in the units of CellMoments.
class MomentSum {
 public:
  /// `offset`: of the cell that `moments` belongs to, in cells.
  void add(const CellMoments& moments, const Eigen::Vector3i& offset);
  [[nodiscard]] Moments in_metres(float cell_m) const;

 private:
  std::array<std::int64_t, 6> outer_{};
  std::array<std::int64_t, 3> sum_{};
  std::int64_t count_ = 0;
};

/// Sums over points relative to the cell's centre, in units of 1/512 of the cell's edge (0.5 mm at 0.25 m).
struct CellMoments {
  /// Units along the edge: a point is at -256 … 256.
  static constexpr int kUnits = 512;
  /// Points at most: beyond it the sums could overflow.
  static constexpr int kMostPoints = 127;

  std::array<std::int32_t, 6> outer{};  ///< xx, yy, zz, xy, xz, yz
  std::array<std::int16_t, 3> sum{};
  std::uint8_t count = 0;
  std::uint8_t reserved = 0;

  /// `fraction`: place in the cell, 0 … 1 along each axis. Nothing happens beyond kMostPoints.
  void add(const Eigen::Vector3f& fraction) {
    if (count >= kMostPoints) {
      return;
    }
    const std::int32_t x = to_units(fraction.x());
    const std::int32_t y = to_units(fraction.y());
    const std::int32_t z = to_units(fraction.z());
    outer[0] += x * x;
    outer[1] += y * y;
    outer[2] += z * z;
    outer[3] += x * y;
    outer[4] += x * z;
    outer[5] += y * z;
    sum[0] = static_cast<std::int16_t>(sum[0] + x);
    sum[1] = static_cast<std::int16_t>(sum[1] + y);
    sum[2] = static_cast<std::int16_t>(sum[2] + z);
    ++count;
  }

  /// In metres, about the cell's centre.
  [[nodiscard]] Moments in_metres(float cell_m) const;

  /// Mean of the points relative to the cell's centre [m]; count must not be 0.
  [[nodiscard]] Eigen::Vector3f mean_m(float cell_m) const {
    return Eigen::Vector3f(sum[0], sum[1], sum[2]) * (cell_m / (static_cast<float>(count) * kUnits));
  }

 private:
  [[nodiscard]] static std::int32_t to_units(float fraction) {
    // Never negative, and lround would cost a call a point.
    const auto units = static_cast<std::int32_t>(fraction * kUnits + 0.5F);  // NOLINT
    return units - kUnits / 2;
  }
};
static_assert(sizeof(CellMoments) == 32);

inline void MomentSum::add(const CellMoments& moments, const Eigen::Vector3i& offset) {
  // sum (p + d)(p + d)^T = sum p p^T + s d^T + d s^T + n d d^T
  const std::int32_t n = moments.count;
  const std::array<std::int32_t, 3> s{moments.sum[0], moments.sum[1], moments.sum[2]};
  const std::array<std::int32_t, 3> d{offset.x() * CellMoments::kUnits, offset.y() * CellMoments::kUnits,
                                      offset.z() * CellMoments::kUnits};
  count_ += n;
  for (std::size_t i = 0; i < 3; ++i) {
    sum_[i] += s[i] + n * d[i];
    outer_[i] += moments.outer[i] + std::int64_t{2 * s[i] + n * d[i]} * d[i];
  }
  constexpr std::array<std::array<std::size_t, 2>, 3> kPairs{{{0, 1}, {0, 2}, {1, 2}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [i, j] = kPairs[k];
    outer_[3 + k] += moments.outer[3 + k] + std::int64_t{s[i] + n * d[i]} * d[j] + std::int64_t{s[j]} * d[i];
  }
}

inline Moments MomentSum::in_metres(float cell_m) const {
  const float unit_m = cell_m / CellMoments::kUnits;
  const float square_m2 = unit_m * unit_m;
  Moments moments;
  moments.count = static_cast<float>(count_);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    moments.sum[axis] = static_cast<float>(sum_[i]) * unit_m;
    moments.outer_diagonal[axis] = static_cast<float>(outer_[i]) * square_m2;
    moments.outer_off_diagonal[axis] = static_cast<float>(outer_[3 + i]) * square_m2;
  }
  return moments;
}

inline Moments CellMoments::in_metres(float cell_m) const {
  MomentSum alone;
  alone.add(*this, Eigen::Vector3i::Zero());
  return alone.in_metres(cell_m);
}

}  // namespace isobar

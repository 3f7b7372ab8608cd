// SPDX-License-Identifier: BSD-3-Clause
// Moments of the points of one cell in fixed point, 32 bytes: integer sums are exact in any order of points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>

#include "core/map/plane_cell.hpp"

namespace isobar {

struct CellMoments;

/// SIMD vectors (GCC and clang extension): one instruction adds four sums.
using FourInts [[gnu::vector_size(16)]] = std::int32_t;
using FourShorts [[gnu::vector_size(8)]] = std::int16_t;

/// Moments of neighbouring cells about the centre of one of them, in the units of CellMoments.
class MomentSum {
 public:
  /// `offset`: from the reference cell to the cell of `moments`, in cells, |offset| <= 4 per axis. Up to 128
  /// cells cannot overflow the sums.
  void add(const CellMoments& moments, const Eigen::Vector3i& offset);
  /// Moments about the centre of the reference cell [m, m^2].
  [[nodiscard]] Moments in_metres(float cell_m) const;

 private:
  FourInts first_outer_{};  // xx, yy, zz, xy; each cell's about its own centre
  FourInts last_outer_{};   // zz, xy, xz, yz; the same
  FourInts sum_{};          // x, y, z, number of points; the same
  FourInts shifted_x_{};    // d_x t_x, d_x t_y, d_x t_z, d_x n, with t as in add()
  FourInts shifted_y_{};
  FourInts shifted_z_{};
};

/// Sums over points about the cell's centre, in units of 1/512 of the cell's edge (0.5 mm at 0.25 m).
struct CellMoments {
  /// Units per edge: coordinates are -256 … 256.
  static constexpr int kUnits = 512;
  /// Capacity: the sum of 127 coordinates is at most 127 * 256, the last multiple of 256 within int16.
  static constexpr int kMostPoints = 127;

  std::array<std::int32_t, 6> outer{};  ///< xx, yy, zz, xy, xz, yz
  std::array<std::int16_t, 4> sum{};    ///< x, y, z, number of points

  /// Adds a point. `fraction`: position in the cell, 0 … 1 per axis. Ignored at kMostPoints.
  void add(const Eigen::Vector3f& fraction) {
    if (count() >= kMostPoints) {
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
    ++sum[3];
  }
  [[nodiscard]] int count() const { return sum[3]; }

  /// Moments about the cell's centre [m, m^2].
  [[nodiscard]] Moments in_metres(float cell_m) const;

  /// Mean of the points from the cell's centre [m]; count() must not be 0.
  [[nodiscard]] Eigen::Vector3f mean_m(float cell_m) const {
    return Eigen::Vector3f(sum[0], sum[1], sum[2]) * (cell_m / (static_cast<float>(count()) * kUnits));
  }

 private:
  [[nodiscard]] static std::int32_t to_units(float fraction) {
    // Adding 0.5 and truncating rounds, since `fraction` >= 0; std::lround would be a library call per point.
    const auto units = static_cast<std::int32_t>(fraction * kUnits + 0.5F);  // NOLINT
    return units - kUnits / 2;
  }
};
static_assert(sizeof(CellMoments) == 32);

// Moments about a centre that is shifted by d: with n points p and their sum s,
// sum (p + d)(p + d)^T = sum p p^T + d t^T + t d^T, where t = s + n d / 2.
inline void MomentSum::add(const CellMoments& moments, const Eigen::Vector3i& offset) {
  FourInts first_outer;
  FourInts last_outer;
  FourShorts sum;
  std::memcpy(&first_outer, moments.outer.data(), sizeof first_outer);
  std::memcpy(&last_outer, moments.outer.data() + 2, sizeof last_outer);
  std::memcpy(&sum, moments.sum.data(), sizeof sum);
  const FourInts d{offset.x(), offset.y(), offset.z(), 0};
  const FourInts s = __builtin_convertvector(sum, FourInts);
  const FourInts t = s + d * (moments.count() * (CellMoments::kUnits / 2));
  first_outer_ += first_outer;
  last_outer_ += last_outer;
  sum_ += s;
  shifted_x_ += t * offset.x();
  shifted_y_ += t * offset.y();
  shifted_z_ += t * offset.z();
}

inline Moments MomentSum::in_metres(float cell_m) const {
  const float unit_m = cell_m / CellMoments::kUnits;
  const float square_m2 = unit_m * unit_m;
  const auto sum = [&](std::int32_t own, std::int32_t shifted) {
    return static_cast<float>(own + std::int64_t{CellMoments::kUnits} * shifted) * unit_m;
  };
  const auto outer = [&](std::int32_t own, std::int32_t dt, std::int32_t td) {
    return static_cast<float>(own + CellMoments::kUnits * (std::int64_t{dt} + td)) * square_m2;
  };
  Moments moments;
  moments.count = static_cast<float>(sum_[3]);
  moments.sum = {sum(sum_[0], shifted_x_[3]), sum(sum_[1], shifted_y_[3]), sum(sum_[2], shifted_z_[3])};
  moments.outer_diagonal = {outer(first_outer_[0], shifted_x_[0], shifted_x_[0]),
                            outer(first_outer_[1], shifted_y_[1], shifted_y_[1]),
                            outer(first_outer_[2], shifted_z_[2], shifted_z_[2])};
  moments.outer_off_diagonal = {outer(first_outer_[3], shifted_x_[1], shifted_y_[0]),
                                outer(last_outer_[2], shifted_x_[2], shifted_z_[0]),
                                outer(last_outer_[3], shifted_y_[2], shifted_z_[1])};
  return moments;
}

inline Moments CellMoments::in_metres(float cell_m) const {
  MomentSum alone;
  alone.add(*this, Eigen::Vector3i::Zero());
  return alone.in_metres(cell_m);
}

}  // namespace isobar

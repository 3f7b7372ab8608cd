// SPDX-License-Identifier: BSD-3-Clause
// Moments of the points of one cell in whole numbers: exact, whatever the order, in 32 bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/map/plane_cell.hpp"

namespace isobar {

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
  [[nodiscard]] Moments in_metres(float cell_m) const {
    const float unit_m = cell_m / kUnits;
    const float square_m2 = unit_m * unit_m;
    Moments moments;
    moments.count = count;
    moments.sum = Eigen::Vector3f(sum[0], sum[1], sum[2]) * unit_m;
    moments.outer_diagonal = Eigen::Vector3i(outer[0], outer[1], outer[2]).cast<float>() * square_m2;
    moments.outer_off_diagonal = Eigen::Vector3i(outer[3], outer[4], outer[5]).cast<float>() * square_m2;
    return moments;
  }

  /// Mean of the points relative to the cell's centre [m]; count must not be 0.
  [[nodiscard]] Eigen::Vector3f mean_m(float cell_m) const {
    return Eigen::Vector3f(sum[0], sum[1], sum[2]) * (cell_m / (static_cast<float>(count) * kUnits));
  }

 private:
  [[nodiscard]] static std::int32_t to_units(float fraction) {
    return static_cast<std::int32_t>(fraction * kUnits + 0.5F) - kUnits / 2;
  }
};
static_assert(sizeof(CellMoments) == 32);

}  // namespace isobar

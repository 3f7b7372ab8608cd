// SPDX-License-Identifier: BSD-3-Clause
// Free space of a scan: a range image in the lidar frame, through which points of the map are tested.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/map/silent_directions.hpp"

namespace isobar {

/// Range image of one scan, 2 degrees per pixel: the minimum range over each pixel and its eight neighbours.
class FreeSpace {
 public:
  /// Up to kMost points in the lidar frame [m], one array per coordinate for SIMD.
  struct Points {
    static constexpr std::size_t kMost = 64;
    std::array<float, kMost> x_m{};
    std::array<float, kMost> y_m{};
    std::array<float, kMost> z_m{};

    void set(std::size_t i, const Eigen::Vector3f& p) {
      x_m[i] = p.x();
      y_m[i] = p.y();
      z_m[i] = p.z();
    }
    [[nodiscard]] Eigen::Vector3f at(std::size_t i) const { return {x_m[i], y_m[i], z_m[i]}; }
  };
  using Ranges = std::array<float, Points::kMost>;

  /// `spacing_m`: largest distance between neighbouring points of the scans, which are thinned.
  explicit FreeSpace(float spacing_m) : spacing_m_(spacing_m) {}

  /// Builds the range image of a scan. `T_lidar_base`: pose of base_link in the lidar frame.
  void set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base);

  /// Minimum range [m] of the pixels around each of the first `count` points; 0 where no ray went. Negative where the
  /// lidar fired and got nothing back (SilentDirections): minus the range up to which nothing is there.
  void min_ranges(const Points& p_lidar, std::size_t count, Ranges& min_range_m) const;

  /// True if the rays around `p_lidar` ended at least `margin_m` behind its surface, measured along the
  /// surface's normal, or were silent. `min_range_m`: the shortest of these rays, from min_ranges(). `normal_lidar`: unit
  /// normal of the surface, or zero if unknown. False for a surface at a grazing angle: small errors of
  /// attitude or height would make rays pass through a floor. Silent rays pass only through what they would meet within
  /// 45 degrees of its normal: glass, water and polish return nothing at other angles.
  [[nodiscard]] static bool passes_through(const Eigen::Vector3f& p_lidar,
                                           const Eigen::Vector3f& normal_lidar, float min_range_m,
                                           float margin_m);

 private:
  using Pixels = std::array<std::int32_t, Points::kMost>;

  static void pixels_of(const Points& p_lidar, std::size_t count, Pixels& pixels);
  void take_minimum_of_neighbours();

  float spacing_m_;
  RangeImage pixel_;
  RangeImage neighbourhood_;  // as from min_ranges()
  RingScatter scatter_;
  SilentDirections silent_;
};

}  // namespace isobar

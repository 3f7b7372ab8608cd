// SPDX-License-Identifier: BSD-3-Clause
// Free space of a scan: a range image in the lidar frame, through which points of the map are tested.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

/// Range image of one scan, 2 degrees per pixel: the minimum range over each pixel and its eight neighbours.
class FreeSpace {
 public:
  static constexpr int kColumns = 180;  ///< azimuth, 360 degrees
  static constexpr int kRows = 90;      ///< elevation, 180 degrees

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

  /// Builds the range image of a scan. `T_lidar_base`: pose of base_link in the lidar frame.
  void set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base);

  /// Minimum range [m] of the pixels around each of the first `count` points; 0 where no ray went.
  void min_ranges(const Points& p_lidar, std::size_t count, Ranges& min_range_m) const;

  /// True if the rays around `p_lidar` ended at least `margin_m` behind its surface, measured along the
  /// surface's normal. `min_range_m`: the shortest of these rays, from min_ranges(). `normal_lidar`: unit
  /// normal of the surface, or zero if unknown. False for a surface at a grazing angle: small errors of
  /// attitude or height would make rays pass through a floor.
  [[nodiscard]] static bool passes_through(const Eigen::Vector3f& p_lidar,
                                           const Eigen::Vector3f& normal_lidar, float min_range_m,
                                           float margin_m);

 private:
  using Pixels = std::array<std::int32_t, Points::kMost>;
  using Image = std::array<float, static_cast<std::size_t>(kColumns) * kRows>;

  static void pixels_of(const Points& p_lidar, std::size_t count, Pixels& pixels);
  void take_minimum_of_neighbours();

  Image pixel_m_{};          // minimum range of each pixel; infinite where no ray went
  Image neighbourhood_m_{};  // minimum range of the pixel and its eight neighbours; 0 where no ray went
};

}  // namespace isobar

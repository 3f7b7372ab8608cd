// SPDX-License-Identifier: BSD-3-Clause
// Which space a scan proved to be empty: a range image of the scan in the lidar's frame.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

/// Shortest range in and around each direction of one scan, 2 degrees a pixel.
class FreeSpace {
 public:
  static constexpr int kColumns = 180;
  static constexpr int kRows = 90;

  /// Up to so many points in the lidar's frame, by coordinate, so that the processor takes four at once [m].
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

  /// Takes the points of a scan. `T_lidar_base`: base_link in the lidar's frame.
  void set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base);

  /// Shortest range in and around the directions of the first `count` points [m]; 0 where no ray went.
  void shortest_around(const Points& p_lidar, std::size_t count, Ranges& shortest_m) const;

  /// True if rays around the direction of `p_lidar`, the shortest of which has `shortest_m`, went farther
  /// than it: by at least `margin_m` measured across its surface. `normal_lidar`: unit normal there, or zero
  /// if unknown. A surface seen at a grazing angle is never called passed, since small errors of attitude or
  /// height would do that to a floor.
  [[nodiscard]] static bool passes_through(const Eigen::Vector3f& p_lidar,
                                           const Eigen::Vector3f& normal_lidar, float shortest_m,
                                           float margin_m);

 private:
  using Pixels = std::array<std::int32_t, Points::kMost>;
  using Image = std::array<float, static_cast<std::size_t>(kColumns) * kRows>;

  static void pixels_of(const Points& p_lidar, std::size_t count, Pixels& pixels);
  void spread_to_neighbours();

  Image shortest_m_{};  // infinite where no ray went
  Image around_m_{};    // shortest of the pixel and its eight neighbours; 0 where no ray went
};

}  // namespace isobar

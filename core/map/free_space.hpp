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

  /// Takes the points of a scan. `T_lidar_base`: base_link in the lidar's frame.
  void set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base);

  /// False where passes_through() is false whatever the normal, which is most often and costs less.
  [[nodiscard]] bool may_pass_through(const Eigen::Vector3f& p_lidar, float margin_m) const;

  /// True if rays around the direction of `p_lidar` went farther than it: by at least `margin_m` measured
  /// across its surface. `normal_lidar`: unit normal there, or zero if unknown. A surface seen at a grazing
  /// angle is never called passed, since small errors of attitude or height would do that to a floor.
  [[nodiscard]] bool passes_through(const Eigen::Vector3f& p_lidar, const Eigen::Vector3f& normal_lidar,
                                    float margin_m) const;

 private:
  [[nodiscard]] static std::size_t index_of(int column, int row) {
    return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
  }
  /// Shortest range in and around the direction of `p_lidar`; 0 where no ray went.
  [[nodiscard]] float around(const Eigen::Vector3f& p_lidar) const;
  static void pixel_of(const Eigen::Vector3f& p_lidar, int& column, int& row);

  void spread_to_neighbours();

  using Image = std::array<float, static_cast<std::size_t>(kColumns) * kRows>;
  Image shortest_m_{};  // infinite where no ray went
  Image around_m_{};    // shortest of the pixel and its eight neighbours; 0 where no ray went
};

}  // namespace isobar

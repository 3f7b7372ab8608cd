// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isobar {

namespace {
constexpr float kPixelRad = 2.0F * std::numbers::pi_v<float> / FreeSpace::kColumns;
// Below this cosine of the angle of incidence a surface is grazed.
constexpr float kLeastCosine = 0.2F;
// What has no normal must be passed by more, since it may be grazed.
constexpr float kMarginWithoutNormal = 2.0F;
constexpr float kNearestM = 0.3F;
}  // namespace

void FreeSpace::pixel_of(const Eigen::Vector3f& p_lidar, int& column, int& row) {
  const float azimuth = std::atan2(p_lidar.y(), p_lidar.x()) + std::numbers::pi_v<float>;
  const float elevation = std::atan2(p_lidar.z(), std::hypot(p_lidar.x(), p_lidar.y()));
  column = std::clamp(static_cast<int>(azimuth / kPixelRad), 0, kColumns - 1);
  row = std::clamp(static_cast<int>((elevation + std::numbers::pi_v<float> / 2) / kPixelRad), 0, kRows - 1);
}

void FreeSpace::set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base) {
  shortest_m_.fill(0.0F);
  const Eigen::Isometry3f T = T_lidar_base.cast<float>();
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    const ScanPoint& point = scan.points[i];
    const Eigen::Vector3f p_lidar = T * Eigen::Vector3f(point.x_m, point.y_m, point.z_m);
    int column = 0;
    int row = 0;
    pixel_of(p_lidar, column, row);
    float& shortest = shortest_m_[index_of(column, row)];
    const float range = p_lidar.norm();
    shortest = shortest == 0.0F ? range : std::min(shortest, range);
  }
}

bool FreeSpace::passes_through(const Eigen::Vector3f& p_lidar, const Eigen::Vector3f& normal_lidar,
                               float margin_m) const {
  const float range = p_lidar.norm();
  if (range < kNearestM) {
    return false;
  }
  float needed = range + kMarginWithoutNormal * margin_m;
  if (!normal_lidar.isZero()) {
    const float cosine = std::abs(normal_lidar.dot(p_lidar)) / range;
    if (cosine < kLeastCosine) {
      return false;
    }
    needed = range + margin_m / cosine;
  }
  int column = 0;
  int row = 0;
  pixel_of(p_lidar, column, row);
  if (shortest_m_[index_of(column, row)] == 0.0F) {
    return false;
  }
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, kRows - 1); ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      const int wrapped = (c + kColumns) % kColumns;
      const float shortest = shortest_m_[index_of(wrapped, r)];
      if (shortest != 0.0F && shortest < needed) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace isobar

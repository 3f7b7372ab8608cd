// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isobar {

namespace {
constexpr float kPixelRad = 2.0F * std::numbers::pi_v<float> / FreeSpace::kColumns;
// Below this cosine of the angle of incidence a surface is grazed.
constexpr float kLeastCosine = 0.2F;
// What has no normal must be passed by more, since it may be grazed.
constexpr float kMarginWithoutNormal = 2.0F;
constexpr float kNearestM = 0.3F;
constexpr float kHalfPi = std::numbers::pi_v<float> / 2;

// Arc tangent of y / x for x, y >= 0, right to 1e-5 rad: a polynomial of Abramowitz and Stegun (4.4.49). A
// pixel is 3500 times wider, and a call of libm for each cell of the map was 13 % of a replay.
float angle_in_quadrant(float y, float x) {
  const float larger = std::max(x, y);
  const float ratio = larger > 0.0F ? std::min(x, y) / larger : 0.0F;
  const float r2 = ratio * ratio;
  const float angle =
      ratio * (0.9998660F + r2 * (-0.3302995F + r2 * (0.1801410F + r2 * (-0.0851330F + r2 * 0.0208351F))));
  return y > x ? kHalfPi - angle : angle;
}
}  // namespace

void FreeSpace::pixel_of(const Eigen::Vector3f& p_lidar, int& column, int& row) {
  const float quadrant = angle_in_quadrant(std::abs(p_lidar.y()), std::abs(p_lidar.x()));
  const float from_front = p_lidar.x() < 0.0F ? 2.0F * kHalfPi - quadrant : quadrant;
  const float azimuth = 2.0F * kHalfPi + (p_lidar.y() < 0.0F ? -from_front : from_front);
  const float across = std::sqrt(p_lidar.x() * p_lidar.x() + p_lidar.y() * p_lidar.y());
  const float steepness = angle_in_quadrant(std::abs(p_lidar.z()), across);
  const float elevation = p_lidar.z() < 0.0F ? -steepness : steepness;
  column = std::clamp(static_cast<int>(azimuth / kPixelRad), 0, kColumns - 1);
  row = std::clamp(static_cast<int>((elevation + kHalfPi) / kPixelRad), 0, kRows - 1);
}

void FreeSpace::set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base) {
  shortest_m_.fill(std::numeric_limits<float>::infinity());
  const Eigen::Isometry3f T = T_lidar_base.cast<float>();
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    const ScanPoint& point = scan.points[i];
    const Eigen::Vector3f p_lidar = T * Eigen::Vector3f(point.x_m, point.y_m, point.z_m);
    int column = 0;
    int row = 0;
    pixel_of(p_lidar, column, row);
    float& shortest = shortest_m_[index_of(column, row)];
    shortest = std::min(shortest, p_lidar.norm());
  }
  spread_to_neighbours();
}

void FreeSpace::spread_to_neighbours() {
  Image beside;  // shortest of each pixel and the ones left and right of it; columns go round
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const float left = shortest_m_[index_of(column > 0 ? column - 1 : kColumns - 1, row)];
      const float right = shortest_m_[index_of(column < kColumns - 1 ? column + 1 : 0, row)];
      beside[index_of(column, row)] = std::min({left, shortest_m_[index_of(column, row)], right});
    }
  }
  for (int row = 0; row < kRows; ++row) {
    const int below = std::max(row - 1, 0);
    const int above = std::min(row + 1, kRows - 1);
    for (int column = 0; column < kColumns; ++column) {
      const std::size_t at = index_of(column, row);
      const float shortest =
          std::min({beside[index_of(column, below)], beside[at], beside[index_of(column, above)]});
      around_m_[at] = std::isinf(shortest_m_[at]) ? 0.0F : shortest;
    }
  }
}

float FreeSpace::around(const Eigen::Vector3f& p_lidar) const {
  int column = 0;
  int row = 0;
  pixel_of(p_lidar, column, row);
  return around_m_[index_of(column, row)];
}

bool FreeSpace::may_pass_through(const Eigen::Vector3f& p_lidar, float margin_m) const {
  const float beyond_m = around(p_lidar) - margin_m;
  return beyond_m > 0.0F && p_lidar.squaredNorm() <= beyond_m * beyond_m;
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
  return around(p_lidar) >= needed;
}

}  // namespace isobar

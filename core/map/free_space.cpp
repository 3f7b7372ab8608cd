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
inline float angle_in_quadrant(float y, float x) {
  const float ratio = std::min(x, y) / std::max(std::max(x, y), std::numeric_limits<float>::min());
  const float r2 = ratio * ratio;
  const float angle =
      ratio * (0.9998660F + r2 * (-0.3302995F + r2 * (0.1801410F + r2 * (-0.0851330F + r2 * 0.0208351F))));
  return y > x ? kHalfPi - angle : angle;
}

std::size_t index_of(int column, int row) {
  return static_cast<std::size_t>(row) * FreeSpace::kColumns + static_cast<std::size_t>(column);
}
}  // namespace

// Written without branches and calls: four points at once.
void FreeSpace::pixels_of(const Points& p, std::size_t count, Pixels& pixels) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = p.x_m[i];
    const float y = p.y_m[i];
    const float z = p.z_m[i];
    const float quadrant = angle_in_quadrant(std::abs(y), std::abs(x));
    const float from_front = x < 0.0F ? 2.0F * kHalfPi - quadrant : quadrant;
    const float azimuth = 2.0F * kHalfPi + (y < 0.0F ? -from_front : from_front);
    const float steepness = angle_in_quadrant(std::abs(z), std::sqrt(x * x + y * y));
    const float elevation = z < 0.0F ? -steepness : steepness;
    const auto column = static_cast<std::int32_t>(azimuth / kPixelRad);
    const auto row = static_cast<std::int32_t>((elevation + kHalfPi) / kPixelRad);
    pixels[i] = std::clamp(row, 0, kRows - 1) * kColumns + std::clamp(column, 0, kColumns - 1);
  }
}

void FreeSpace::shortest_around(const Points& p_lidar, std::size_t count, Ranges& shortest_m) const {
  Pixels pixels;
  pixels_of(p_lidar, count, pixels);
  for (std::size_t i = 0; i < count; ++i) {
    shortest_m[i] = around_m_[static_cast<std::size_t>(pixels[i])];
  }
}

void FreeSpace::set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base) {
  shortest_m_.fill(std::numeric_limits<float>::infinity());
  const Eigen::Isometry3f T = T_lidar_base.cast<float>();
  Points batch;
  Pixels pixels;
  for (std::size_t first = 0; first < scan.point_count; first += Points::kMost) {
    const std::size_t count = std::min<std::size_t>(Points::kMost, scan.point_count - first);
    for (std::size_t i = 0; i < count; ++i) {
      const ScanPoint& point = scan.points[first + i];
      batch.set(i, T * Eigen::Vector3f(point.x_m, point.y_m, point.z_m));
    }
    pixels_of(batch, count, pixels);
    for (std::size_t i = 0; i < count; ++i) {
      float& shortest = shortest_m_[static_cast<std::size_t>(pixels[i])];
      shortest = std::min(shortest, batch.at(i).norm());
    }
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

bool FreeSpace::passes_through(const Eigen::Vector3f& p_lidar, const Eigen::Vector3f& normal_lidar,
                               float shortest_m, float margin_m) {
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
  return shortest_m >= needed;
}

}  // namespace isobar

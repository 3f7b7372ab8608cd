// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isobar {

namespace {
constexpr int kColumns = RangeImage::kColumns;
constexpr int kRows = RangeImage::kRows;
constexpr float kPixelRad = 2.0F * std::numbers::pi_v<float> / kColumns;
// Cosine of the angle between ray and normal below which the ray counts as grazing: beyond 78 degrees of
// incidence, small errors of attitude or height carry the ray across the surface.
constexpr float kMinIncidenceCosine = 0.2F;
// The same for a ray without a return: a cosine of 45 degrees.
constexpr float kMinSilentCosine = 0.7F;
// Factor on the margin of a point without a normal: its angle of incidence is unknown and may be grazing.
constexpr float kMarginFactorWithoutNormal = 2.0F;
// Minimum range of a point that is tested [m]: nearer, one cell covers many pixels.
constexpr float kMinRangeM = 0.3F;
constexpr float kHalfPi = std::numbers::pi_v<float> / 2;

// atan(y / x) for x, y >= 0 to 1e-5 rad: polynomial 4.4.49 of Abramowitz and Stegun. A pixel is 3500 times
// wider. std::atan2 for each cell of the map took 13 % of a replay.
inline float angle_in_quadrant(float y, float x) {
  const float ratio = std::min(x, y) / std::max(std::max(x, y), std::numeric_limits<float>::min());
  const float r2 = ratio * ratio;
  const float angle =
      ratio * (0.9998660F + r2 * (-0.3302995F + r2 * (0.1801410F + r2 * (-0.0851330F + r2 * 0.0208351F))));
  return y > x ? kHalfPi - angle : angle;
}

}  // namespace

// Without branches and calls, so that the compiler vectorises it: four points at once.
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

void FreeSpace::min_ranges(const Points& p_lidar, std::size_t count, Ranges& min_range_m) const {
  Pixels pixels;
  pixels_of(p_lidar, count, pixels);
  for (std::size_t i = 0; i < count; ++i) {
    min_range_m[i] = neighbourhood_.range_m[static_cast<std::size_t>(pixels[i])];
  }
}

void FreeSpace::set_scan(const RegisteredScan& scan, const Eigen::Isometry3d& T_lidar_base) {
  pixel_.range_m.fill(std::numeric_limits<float>::infinity());
  scatter_.clear();
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
      float& shortest = pixel_.range_m[static_cast<std::size_t>(pixels[i])];
      const float range_m = batch.at(i).norm();
      shortest = std::min(shortest, range_m);
      scatter_.add(scan.points[first + i].ring, batch.z_m[i] / std::max(range_m, kMinRangeM));
    }
  }
  silent_.set_scan(pixel_, scatter_, spacing_m_);
  take_minimum_of_neighbours();
}

// Minimum over 3 x 3 pixels, separable: first along the rows, then along the columns.
void FreeSpace::take_minimum_of_neighbours() {
  RangeImage of_row;  // minimum of a pixel and its left and right neighbours; azimuth wraps around
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const float left = pixel_.range_m[RangeImage::index_of(column > 0 ? column - 1 : kColumns - 1, row)];
      const float right = pixel_.range_m[RangeImage::index_of(column < kColumns - 1 ? column + 1 : 0, row)];
      of_row.range_m[RangeImage::index_of(column, row)] =
          std::min({left, pixel_.range_m[RangeImage::index_of(column, row)], right});
    }
  }
  for (int row = 0; row < kRows; ++row) {
    const int below = std::max(row - 1, 0);
    const int above = std::min(row + 1, kRows - 1);
    for (int column = 0; column < kColumns; ++column) {
      const std::size_t at = RangeImage::index_of(column, row);
      const float shortest =
          std::min({of_row.range_m[RangeImage::index_of(column, below)], of_row.range_m[at],
                    of_row.range_m[RangeImage::index_of(column, above)]});
      const float silent_m = silent_.silent(at) ? -std::min(shortest, silent_.reach_m()) : 0.0F;
      neighbourhood_.range_m[at] = std::isinf(pixel_.range_m[at]) ? silent_m : shortest;
    }
  }
}

bool FreeSpace::passes_through(const Eigen::Vector3f& p_lidar, const Eigen::Vector3f& normal_lidar,
                               float min_range_m, float margin_m) {
  const float range_m = p_lidar.norm();
  if (range_m < kMinRangeM) {
    return false;
  }
  const bool silent = min_range_m < 0.0F;
  float required_m = range_m + kMarginFactorWithoutNormal * margin_m;
  if (!normal_lidar.isZero()) {
    const float cosine = std::abs(normal_lidar.dot(p_lidar)) / range_m;
    if (cosine < (silent ? kMinSilentCosine : kMinIncidenceCosine)) {
      return false;
    }
    required_m = range_m + margin_m / cosine;
  }
  return std::abs(min_range_m) >= required_m;
}

}  // namespace isobar

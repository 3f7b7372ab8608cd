// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/grid/true_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace isobar::bench {

namespace {

constexpr double kSampleM = 0.03;

std::uint64_t key_of(const TrueSection::Square& square) {
  return std::uint64_t{static_cast<std::uint32_t>(square.x())} << 32U |
         static_cast<std::uint32_t>(square.y());
}

}  // namespace

TrueSection::TrueSection(const std::vector<files::SurfaceTriangle>& triangles) {
  for (const files::SurfaceTriangle& triangle : triangles) add(triangle);
  for (auto& [key, layers] : layers_) {
    std::sort(layers.begin(), layers.end());
    layers.erase(std::unique(layers.begin(), layers.end()), layers.end());
  }
}

void TrueSection::add(const Eigen::Vector3d& p) {
  const auto layer = static_cast<std::int16_t>(std::floor(p.z() / kLayerM));
  std::vector<std::int16_t>& layers = layers_[key_of(square_of(p.head<2>()))];
  if (layers.empty() || layers.back() != layer) layers.push_back(layer);
}

// Samples, by rows along two edges. Floors and ceilings are left out: they are no walls at any height.
void TrueSection::add(const files::SurfaceTriangle& triangle) {
  const Eigen::Vector3d a = triangle[0].cast<double>();
  const Eigen::Vector3d ab = triangle[1].cast<double>() - a;
  const Eigen::Vector3d ac = triangle[2].cast<double>() - a;
  const Eigen::Vector3d normal = ab.cross(ac);
  if (std::abs(normal.z()) > 0.7 * normal.norm()) return;
  const int rows = static_cast<int>(std::ceil(ac.norm() / kSampleM));
  for (int j = 0; j <= rows; ++j) {
    const double v = rows == 0 ? 0.0 : static_cast<double>(j) / rows;
    const int columns = static_cast<int>(std::ceil(ab.norm() * (1.0 - v) / kSampleM));
    for (int i = 0; i <= columns; ++i) {
      const double u = columns == 0 ? 0.0 : (1.0 - v) * i / columns;
      add(a + u * ab + v * ac);
    }
  }
}

bool TrueSection::is_wall(const Square& square, double low_m, double high_m) const {
  const auto found = layers_.find(key_of(square));
  if (found == layers_.end()) return false;
  const auto first = static_cast<std::int16_t>(std::floor(low_m / kLayerM));
  const auto last = static_cast<std::int16_t>(std::floor(high_m / kLayerM));
  const auto at = std::lower_bound(found->second.begin(), found->second.end(), first);
  return at != found->second.end() && *at <= last;
}

bool TrueSection::is_near_wall(const Square& square, double low_m, double high_m, int reach) const {
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      if (is_wall(square + Square(dx, dy), low_m, high_m)) return true;
    }
  }
  return false;
}

}  // namespace isobar::bench

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/map/free_space.hpp"

namespace isobar::test::test_free_space {

namespace {

using isobar::FreeSpace;
using isobar::RegisteredScan;
using isobar::ScanPoint;

constexpr float kRadPerDeg = std::numbers::pi_v<float> / 180.0F;

Eigen::Vector3f ray(float azimuth_deg, float elevation_deg, float range) {
  const float a = azimuth_deg * kRadPerDeg;
  const float e = elevation_deg * kRadPerDeg;
  return range * Eigen::Vector3f(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
}

// Scan of a sphere with a radius of 10 m by a 16-beam lidar in its centre.
std::unique_ptr<RegisteredScan> scan_of_sphere() {
  auto scan = std::make_unique<RegisteredScan>();
  scan->point_count = 0;
  for (int azimuth = 0; azimuth < 720; ++azimuth) {
    for (int ring = -15; ring <= 15; ring += 2) {
      const Eigen::Vector3f p = ray(0.5F * static_cast<float>(azimuth), static_cast<float>(ring), 10.0F);
      scan->points[scan->point_count++] = ScanPoint{p.x(), p.y(), p.z(), 0, 0, 0};
    }
  }
  return scan;
}

bool passes_through(const FreeSpace& free_space, const Eigen::Vector3f& p_lidar,
                    const Eigen::Vector3f& normal) {
  FreeSpace::Points points;
  FreeSpace::Ranges min_range_m{};
  points.set(0, p_lidar);
  free_space.min_ranges(points, 1, min_range_m);
  return FreeSpace::passes_through(p_lidar, normal, min_range_m[0], 0.3F);
}

}  // namespace

TEST_CASE("rays pass through a point in front of their ends, not behind them or where no ray goes") {
  auto free_space = std::make_unique<FreeSpace>(0.275F);
  free_space->set_scan(*scan_of_sphere(), Eigen::Isometry3d::Identity());
  const Eigen::Vector3f towards = -ray(33.0F, 1.0F, 1.0F);
  CHECK(passes_through(*free_space, ray(33.0F, 1.0F, 5.0F), towards));
  CHECK_FALSE(passes_through(*free_space, ray(33.0F, 1.0F, 9.8F), towards));
  CHECK_FALSE(passes_through(*free_space, ray(33.0F, 1.0F, 12.0F), towards));
  CHECK_FALSE(passes_through(*free_space, ray(33.0F, 60.0F, 5.0F), -ray(33.0F, 60.0F, 1.0F)));
}

TEST_CASE("rays never pass through a surface that they graze, however far they go") {
  auto free_space = std::make_unique<FreeSpace>(0.275F);
  free_space->set_scan(*scan_of_sphere(), Eigen::Isometry3d::Identity());
  // A floor 0.1 m under the rays, seen at one degree.
  CHECK_FALSE(passes_through(*free_space, ray(120.0F, -1.0F, 5.0F), Eigen::Vector3f::UnitZ()));
}

}  // namespace isobar::test::test_free_space

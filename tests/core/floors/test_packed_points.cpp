// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/packed_points.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace isobar::test::test_packed_points {

TEST_CASE("packed points of a tile come back within a tenth of a millimetre, normals within half a degree") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-4.4, 4.4);
  std::uniform_real_distribution<float> part(-1.0F, 1.0F);
  std::vector<MapPoint> points(1'000);
  for (MapPoint& point : points) {
    point.p_map =
        Eigen::Vector3d(place(random), place(random), place(random)) + Eigen::Vector3d(1e5, -2e4, 300.0);
    point.normal_map = Eigen::Vector3f(part(random), part(random), part(random)).normalized();
    point.observations = static_cast<std::uint8_t>(random() % 128);
    point.filled = static_cast<std::uint8_t>(random() % 28);
  }
  points.front().normal_map.setZero();
  std::vector<MapPoint> again{MapPoint()};
  PackedPoints(points).unpack(again);
  REQUIRE(again.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The extent is 8.8 m: steps of 0.13 mm, rounded on each axis.
    CHECK((again[i].p_map - points[i].p_map).cwiseAbs().maxCoeff() < 7e-5);
    CHECK((again[i].normal_map - points[i].normal_map).norm() < 0.009F);
    CHECK(again[i].observations == points[i].observations);
    CHECK(again[i].filled == points[i].filled);
  }
  CHECK(again.front().normal_map.isZero());
}

TEST_CASE("a single point is packed exactly, none as none, and what is no number is left out") {
  MapPoint point;
  point.p_map = {1.25, -3.5, 700.0};
  MapPoint bad = point;
  bad.p_map.y() = std::numeric_limits<double>::quiet_NaN();
  MapPoint far = point;
  far.p_map.x() = 1e9;
  std::vector<MapPoint> again;
  PackedPoints(std::vector{bad, point, far}).unpack(again);
  REQUIRE(again.size() == 1);
  CHECK(again.front().p_map.isApprox(point.p_map, 1e-12));
  PackedPoints(std::vector{bad}).unpack(again);
  CHECK(again.empty());
}

}  // namespace isobar::test::test_packed_points

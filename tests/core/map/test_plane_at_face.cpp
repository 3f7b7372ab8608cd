// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <random>

#include "core/map/local_map.hpp"
#include "tests/core/map/nearest_match.hpp"

namespace isobar::test::test_plane_at_face {

namespace {

constexpr float kNoiseM = 0.01F;

// Map of a floor at `floor_m`, seen with noise by a robot that stands on it.
std::unique_ptr<LocalMap> map_of_floor(float floor_m) {
  auto map = std::make_unique<LocalMap>(MapConfig{}, Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.55)));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> along(-3.0F, 3.0F);
  std::normal_distribution<float> noise(0.0F, kNoiseM);
  auto scan = std::make_unique<RegisteredScan>();
  for (int i = 0; i < 30; ++i) {
    scan->pose = {};
    scan->pose.stamp_ns = (i + 1) * 2'000'000'000LL;
    scan->pose.mode = PoseMode::kRegistered;
    scan->pose.overlap = 1.0;
    scan->point_count = 0;
    for (int k = 0; k < 2000; ++k) {
      scan->points[scan->point_count++] =
          ScanPoint{along(random), along(random), floor_m + noise(random), 0, 0, 0};
    }
    map->update(*scan);
  }
  return map;
}

// Mean distance above the planes of points that lie `above_m` above the floor, with the noise of the range.
double mean_residual_m(float floor_m, double above_m) {
  const auto map = map_of_floor(floor_m);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> along(-2.5, 2.5);
  std::normal_distribution<double> noise(0.0, static_cast<double>(kNoiseM));
  double sum = 0.0;
  int found = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d p(along(random), along(random),
                            static_cast<double>(floor_m) + above_m + noise(random));
    const auto match = nearest_match(*map->snapshot(), p, {0.0, 0.0, 0.55}, 0.35);
    if (!match) continue;
    sum += match->normal_map.cast<double>().dot(p - match->q_map);
    ++found;
  }
  REQUIRE(found > 3900);
  return sum / found;
}

}  // namespace

TEST_CASE("a floor shows where it is, wherever the faces of the grid lie") {
  const auto cell_m = static_cast<float>(MapConfig().cell_m);
  // In the middle of a cell, on a face, and with the face within the noise.
  for (const float floor_m : {0.5F * cell_m, 0.0F, 0.004F, cell_m - 0.008F}) {
    CAPTURE(floor_m);
    // 4000 points of 1 cm: 0.2 mm; the map averages 30 scans. A face that cuts the floor in two hides half of a step.
    CHECK(std::abs(mean_residual_m(floor_m, 0.0)) < 0.001);
    CHECK(std::abs(mean_residual_m(floor_m, 0.006) - 0.006) < 0.0015);
  }
}

}  // namespace isobar::test::test_plane_at_face

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry.hpp"
#include "core/place/correlative_search.hpp"
#include "core/place/slab_pyramid.hpp"
#include "tests/core/place/building.hpp"

namespace isobar::test::test_correlative_search {
namespace {

constexpr double kStepRad = 2.0 * std::numbers::pi / kYawSteps;

struct Slab {
  explicit Slab(const std::vector<MapPoint>& points, double z_m = 0.0) {
    structure.set_points(points);
    built = image.build(structure, {z_m, 0.1});
    pyramid.build(image);
  }
  StructureMap structure;
  SlabImage image;
  SlabPyramid pyramid;
  bool built = false;
};

std::vector<Eigen::Vector2f> columns_seen(const Building& building, const Eigen::Isometry3d& T_map_level,
                                          std::size_t most) {
  PlaceQuery query;
  building.look(T_map_level, query);
  std::vector<Eigen::Vector2f> columns(query.columns().begin(), query.columns().end());
  std::vector<Eigen::Vector2f> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(columns[i * columns.size() / most]);
  return some;
}

double score_at(const Slab& slab, const std::vector<Eigen::Vector2f>& columns, int column, int row, int yaw) {
  const double angle = yaw * kStepRad;
  const auto cosine = static_cast<float>(std::cos(angle) / static_cast<double>(kPlaceCellM));
  const auto sine = static_cast<float>(std::sin(angle) / static_cast<double>(kPlaceCellM));
  double sum = 0.0;
  for (const Eigen::Vector2f& p : columns) {
    const int x = column + static_cast<int>(std::floor(cosine * p.x() - sine * p.y() + 0.5F));
    const int y = row + static_cast<int>(std::floor(sine * p.x() + cosine * p.y() + 0.5F));
    sum += slab.image.scores()[static_cast<std::size_t>(y) * static_cast<std::size_t>(slab.image.width()) +
                               static_cast<std::size_t>(x)];
  }
  return sum / double(columns.size() * SlabImage::kFullScore);
}

bool hides(const SlabPose& better, const SlabPose& worse, const SearchLimits& limits) {
  return std::abs(better.x_m - worse.x_m) < limits.apart_m &&
         std::abs(better.y_m - worse.y_m) < limits.apart_m &&
         std::abs(std::remainder(better.yaw_rad - worse.yaw_rad, 2.0 * std::numbers::pi)) < limits.apart_rad;
}

}  // namespace

TEST_CASE("branch and bound finds what an exhaustive search finds") {
  const Building building = office();
  const Slab slab(building.points());
  REQUIRE(slab.built);
  const std::vector<Eigen::Vector2f> columns =
      columns_seen(building, level_pose_at(1.1, -0.7, 0.0, 40.0), 60);
  SearchWindow window;
  window.box = {{-1.0, -2.5}, {2.0, 1.0}};
  window.yaw_rad = 0.5;
  window.half_yaw_rad = 0.6;
  SearchLimits limits;
  limits.least_score = 0.3;
  limits.least_share_of_best = 0.5;
  CorrelativeSearch search;
  const std::vector<SlabPose> found = search.find(slab.image, slab.pyramid, columns, window, limits);
  REQUIRE(search.complete());
  REQUIRE(found.size() > 3);

  // Each pose of the window that scores more than the n-th result is hidden by one of the results before.
  std::size_t compared = 0;
  const auto low_column = static_cast<int>(std::floor(-1.0 / 0.2)) - slab.image.first_x();
  const auto low_row = static_cast<int>(std::floor(-2.5 / 0.2)) - slab.image.first_y();
  for (int yaw = 0; yaw < kYawSteps; ++yaw) {
    const double yaw_rad = yaw * kStepRad;
    if (std::abs(std::remainder(yaw_rad - window.yaw_rad, 2.0 * std::numbers::pi)) > window.half_yaw_rad)
      continue;
    for (int row = low_row; row < low_row + 17; ++row) {
      for (int column = low_column; column < low_column + 15; ++column) {
        if (!slab.pyramid.standing(0, column, row)) continue;
        SlabPose pose;
        pose.x_m = (slab.image.first_x() + column + 0.5) * static_cast<double>(kPlaceCellM);
        pose.y_m = (slab.image.first_y() + row + 0.5) * static_cast<double>(kPlaceCellM);
        pose.yaw_rad = yaw_rad;
        pose.score = score_at(slab, columns, column, row, yaw);
        ++compared;
        for (std::size_t n = 0; n < found.size(); ++n) {
          if (pose.score <= found[n].score + 1e-9) continue;
          const bool hidden = std::any_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(n),
                                          [&](const SlabPose& one) { return hides(one, pose, limits); });
          CHECK_MESSAGE(hidden, "score ", pose.score, " at ", pose.x_m, " ", pose.y_m, " ", pose.yaw_rad);
        }
      }
    }
  }
  CHECK(compared > 20'000);
  CHECK(std::abs(found.front().x_m - 1.1) < 0.2);
  CHECK(std::abs(found.front().y_m + 0.7) < 0.2);
  CHECK(std::abs(found.front().yaw_rad - 40.0 * kRadPerDeg) < 0.02);
}

TEST_CASE("the score is the same when map and robot are moved together, and the pose moves with them") {
  const Building building = office();
  std::vector<MapPoint> points = building.points();
  // No wall lies on the border of two cells.
  for (MapPoint& point : points) point.p_map.array() += 0.07;
  const Slab slab(points, 0.07);
  const std::vector<Eigen::Vector2f> columns =
      columns_seen(building, level_pose_at(13.3, 0.6, 0.0, -75.0), 200);
  CorrelativeSearch search;
  const SlabPose before = search.find(slab.image, slab.pyramid, columns, {}, {}).front();

  // A quarter turn and whole cells are exact on the grid; 62 and -16 cells.
  const Eigen::Vector3d step(12.4, -3.2, 40.0);
  for (MapPoint& point : points) {
    point.p_map = Eigen::Vector3d(-point.p_map.y(), point.p_map.x(), point.p_map.z()) + step;
    point.normal_map = Eigen::Vector3f(-point.normal_map.y(), point.normal_map.x(), point.normal_map.z());
  }
  const Slab moved(points, 40.07);
  REQUIRE(moved.built);
  const SlabPose after = search.find(moved.image, moved.pyramid, columns, {}, {}).front();
  // A few of the columns lie on the border of two cells and fall to the other one when the grid is turned.
  CHECK(after.score == doctest::Approx(before.score).epsilon(0.01));
  CHECK(std::abs(after.x_m - (-before.y_m + step.x())) < 0.01);
  CHECK(std::abs(after.y_m - (before.x_m + step.y())) < 0.01);
  CHECK(std::abs(std::remainder(after.yaw_rad - before.yaw_rad - 0.5 * kPi, 2.0 * kPi)) < 0.02);
}

TEST_CASE("a search in a window of some metres gives no pose outside of it") {
  const Building building = office();
  const Slab slab(building.points());
  const std::vector<Eigen::Vector2f> columns =
      columns_seen(building, level_pose_at(1.1, -0.7, 0.0, 40.0), 200);
  SearchWindow window;
  window.box = {{-3.0, -1.0}, {0.0, 2.0}};
  window.half_yaw_rad = 0.3;
  SearchLimits limits;
  limits.least_score = 0.05;
  CorrelativeSearch search;
  const std::vector<SlabPose>& found = search.find(slab.image, slab.pyramid, columns, window, limits);
  REQUIRE(!found.empty());
  for (const SlabPose& pose : found) {
    CHECK(pose.x_m > -3.2);
    CHECK(pose.x_m < 0.2);
    CHECK(pose.y_m > -1.2);
    CHECK(pose.y_m < 2.2);
    CHECK(std::abs(pose.yaw_rad) <= 0.3 + 1e-6);
  }
}

TEST_CASE("a search that runs out of time says so") {
  const Building building = office();
  const Slab slab(building.points());
  const std::vector<Eigen::Vector2f> columns =
      columns_seen(building, level_pose_at(1.1, -0.7, 0.0, 40.0), 200);
  SearchLimits limits;
  limits.most_sums = 1000;
  CorrelativeSearch search;
  static_cast<void>(search.find(slab.image, slab.pyramid, columns, {}, limits));
  CHECK(!search.complete());
}

TEST_CASE("a map that is no map gives no slab") {
  StructureMap structure;
  SlabImage image;
  CHECK(!image.build(structure, {0.0, 0.1}));
  const double nan = std::nan("");
  std::vector<MapPoint> points(3);
  points[0].p_map << nan, 0.0, 0.0;
  points[1].p_map << 0.0, 1e300, 0.0;
  points[2].p_map << 0.0, 0.0, 1e9;
  for (MapPoint& point : points) point.normal_map = Eigen::Vector3f::UnitZ();
  structure.set_points(points);
  CHECK(structure.voxel_count() == 0);
  // Two points of ground that are farther apart than any image.
  points[0].p_map << -9e4, -9e4, 0.0;
  points[1].p_map << 9e4, 9e4, 0.0;
  structure.set_points(points);
  CHECK(!image.build(structure, {0.0, 0.1}));
  CHECK(image.empty());
}

}  // namespace isobar::test::test_correlative_search

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "core/place/place_fit.hpp"
#include "tests/core/place/building.hpp"

namespace isobar::test::test_place_fit {
namespace {

struct Fitted {
  PlaceFit fine;
  PlaceFit coarse;
  PlaceEvidence evidence;
};

Fitted fit_at(const Building& in_map, const PlaceQuery& query, const Eigen::Isometry3d& T_map_level) {
  const KnownMap map = in_map.map();
  SlabImage image;
  REQUIRE(image.build(map.structure(), {T_map_level.translation().z(), 0.1}));
  std::vector<PlaneMatch> matches;
  Fitted fitted;
  fitted.fine = fine_fit(*map.snapshot(), image, query, T_map_level, matches, fitted.evidence);
  const Eigen::Matrix3d R = T_map_level.linear();
  fitted.coarse = coarse_fit(
      image, query,
      {T_map_level.translation().x(), T_map_level.translation().y(), std::atan2(R(1, 0), R(0, 0)), 0.0});
  return fitted;
}

}  // namespace

TEST_CASE("the right pose fits: walls lie on walls, and rays pass through none") {
  const Eigen::Isometry3d T = level_pose_at(1.1, -0.7, 0.0, 40.0);
  PlaceQuery query;
  office().look(T, query);
  const Fitted there = fit_at(office(), query, T);
  CHECK(there.fine.walls > 0.9);
  CHECK(there.fine.others > 0.9);
  CHECK(there.fine.passed < 0.01);
  CHECK(there.coarse.walls > 0.9);
  CHECK(there.coarse.passed < 0.01);
  const Fitted beside = fit_at(office(), query, level_pose_at(1.6, -0.4, 0.0, 40.0));
  CHECK(beside.fine.walls < 0.4);
  CHECK(PlaceEvidence::lead(there.evidence, beside.evidence) > 5.0);
  CHECK(PlaceEvidence::lead(beside.evidence, there.evidence) < -5.0);
}

TEST_CASE(
    "rays that pass through a wall of the map contradict the place, though all that they meet is in the "
    "map") {
  const Eigen::Isometry3d T = level_pose_at(-2.0, 2.0, 0.0, 10.0);
  PlaceQuery query;
  office().look(T, query);
  Building divided = office();
  divided.add_obstacle({0.0, -4.0, 0.0}, {0.3, 4.0, 3.0});
  const Fitted fitted = fit_at(divided, query, T);
  CHECK(fitted.fine.walls > 0.9);
  CHECK(fitted.fine.passed > 0.02);
  CHECK(fitted.coarse.passed > 0.02);
}

TEST_CASE("ground and ceiling tell by how much a height is off") {
  const Eigen::Isometry3d T = level_pose_at(1.1, -0.7, 0.0, 40.0);
  PlaceQuery query;
  office().look(T, query);
  const KnownMap map = office().map();
  std::vector<PlaneMatch> matches;
  for (const double off_m : {-0.4, -0.2, 0.0, 0.1, 0.3}) {
    CAPTURE(off_m);
    Eigen::Isometry3d T_off = T;
    T_off.translation().z() += off_m;
    CHECK(std::abs(vertical_offset_m(*map.snapshot(), query, T_off, matches) + off_m) < 1e-6);
  }
}

TEST_CASE("equal places lead by nothing") {
  PlaceEvidence one;
  one.items.assign(500, 0.9F);
  CHECK(PlaceEvidence::lead(one, one) == 0.0);
  PlaceEvidence noisy = one;
  for (std::size_t i = 0; i < noisy.items.size(); ++i) noisy.items[i] += i % 2 == 0 ? 0.1F : -0.1F;
  CHECK(PlaceEvidence::lead(one, noisy) == 0.0);
  PlaceEvidence worse = one;
  for (std::size_t i = 0; i < 50; ++i) worse.items[i] = 0.0F;
  CHECK(PlaceEvidence::lead(one, worse) > 3.0);
}

TEST_CASE("a query drops what no lidar measures, and judges nothing by too little") {
  PlaceQuery query;
  const float nan = std::nanf("");
  const std::vector<Eigen::Vector3f> points{
      {nan, 0.0F, 1.0F}, {1e30F, 0.0F, 1.0F}, {1.0F, 0.0F, -1e30F}, {3.0F, 0.0F, 1.0F}};
  query.add(points, Eigen::Vector3f(0.0F, 0.0F, 0.6F));
  query.finish();
  CHECK(query.sample().size() == 1);
  CHECK(!query.can_judge());
  office().look(level_pose_at(1.1, -0.7, 0.0, 40.0), query);
  CHECK(query.can_judge());
  CHECK(query.columns().size() <= PlaceQuery::kMostColumns);
  CHECK(std::abs(query.ground_z_m()) < 0.05F);
}

}  // namespace isobar::test::test_place_fit

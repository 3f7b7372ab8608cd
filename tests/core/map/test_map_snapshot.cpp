// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "core/map/map_block.hpp"
#include "core/map/nearest_plane.hpp"
#include "core/map/plane_hash.hpp"
#include "tests/core/map/nearest_match.hpp"

namespace isobar::test::test_map_snapshot {

namespace {

using isobar::CellIndex;
using isobar::LocalFrame;
using isobar::MapSnapshot;
using isobar::MatchQuery;
using isobar::NearestPlane;
using isobar::PackedPlane;
using isobar::PlaneHash;
using isobar::PlaneMatch;
using isobar::PlaneTile;
using isobar::TileKey;
using isobar::TileTree;

constexpr float kCellM = 0.25F;
// Far from the origin, where single precision in map coordinates would fail.
const Eigen::Vector3d kFarAway(8000.0, -5000.0, 0.0);

struct WorldPlane {
  Eigen::Vector3d q;
  Eigen::Vector3f normal;
  CellIndex cell;
};

// Planes in several tiles, at most one per cell, with their points inside the cells.
std::vector<WorldPlane> random_planes(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> place(-11.0, 11.0);
  std::normal_distribution<float> direction;
  std::map<std::array<int, 3>, WorldPlane> planes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f normal(direction(random), direction(random), direction(random));
    const Eigen::Vector3d q = kFarAway + Eigen::Vector3d(place(random), place(random), place(random));
    const LocalFrame frame(q, kCellM);
    const CellIndex cell = frame.cell_of(frame.to_local(q));
    planes.insert({{cell.x(), cell.y(), cell.z()}, {q, normal.normalized(), cell}});
  }
  std::vector<WorldPlane> list;
  for (const auto& [cell, plane] : planes) list.push_back(plane);
  return list;
}

std::vector<std::shared_ptr<const PlaneTile>> tiles_of(const std::vector<WorldPlane>& planes) {
  std::map<TileKey, std::map<std::size_t, std::map<int, PackedPlane>>> sorted;
  for (const WorldPlane& plane : planes) {
    const TileKey key = isobar::tile_of(plane.cell);
    const std::size_t block = isobar::block_of(plane.cell);
    const Eigen::Vector3d centre =
        (isobar::first_cell(key, block).cast<double>().array() + 0.5 * isobar::kBlockCells) * double{kCellM};
    sorted[key][block][isobar::place_of(plane.cell)] =
        PackedPlane::of((plane.q - centre).cast<float>(), plane.normal, kCellM);
  }
  std::vector<std::shared_ptr<const PlaneTile>> tiles;
  for (const auto& [key, blocks] : sorted) {
    auto tile = std::make_shared<PlaneTile>();
    tile->key = key;
    for (const auto& [index, members] : blocks) {
      auto block = std::make_shared<isobar::PlaneBlock>();
      for (const auto& [slot, plane] : members) {
        block->mask.insert(slot);
        block->planes.push_back(plane);
      }
      tile->plane_count += members.size();
      tile->blocks[index] = std::move(block);
    }
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

std::unique_ptr<MapSnapshot> nearest_plane_of(const std::vector<WorldPlane>& planes) {
  std::vector<std::shared_ptr<const TileTree>> trees;
  for (const auto& tile : tiles_of(planes)) trees.push_back(std::make_shared<const TileTree>(*tile, kCellM));
  return std::make_unique<NearestPlane>(std::move(trees), kCellM);
}

std::unique_ptr<MapSnapshot> plane_hash_of(const std::vector<WorldPlane>& planes) {
  return std::make_unique<PlaneHash>(tiles_of(planes), kCellM);
}

bool faces(const WorldPlane& plane, const Eigen::Vector3d& viewpoint) {
  return plane.normal.cast<double>().dot(viewpoint - plane.q) > 0.0;
}

double off_plane(const WorldPlane& plane, const Eigen::Vector3d& p) {
  return std::abs(plane.normal.cast<double>().dot(p - plane.q));
}

const WorldPlane* nearest_of_all(const std::vector<WorldPlane>& planes, const Eigen::Vector3d& p,
                                 const Eigen::Vector3d& viewpoint, double max_distance) {
  const WorldPlane* best = nullptr;
  for (const WorldPlane& plane : planes) {
    const double distance = (plane.q - p).norm();
    if (distance < max_distance && faces(plane, viewpoint)) {
      max_distance = distance;
      best = &plane;
    }
  }
  return best;
}

// Tolerance of a stored point: the resolution is 2 m / 2^15 = 61 um, so the error is 31 um per axis.
constexpr double kStoredM = 1e-4;

}  // namespace

TEST_CASE("the k-d trees find the same nearest facing plane as an exhaustive search") {
  std::mt19937 random(7);
  const std::vector<WorldPlane> planes = random_planes(random, 3000);
  const auto snapshot = nearest_plane_of(planes);
  REQUIRE(snapshot->plane_count() == planes.size());
  std::uniform_real_distribution<double> place(-12.0, 12.0);
  constexpr double kMaxDistance = 1.2;
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = kFarAway + Eigen::Vector3d(place(random), place(random), place(random));
    const Eigen::Vector3d viewpoint = p + Eigen::Vector3d(place(random), place(random), place(random));
    const WorldPlane* best = nearest_of_all(planes, p, viewpoint, kMaxDistance);
    const auto match = nearest_match(*snapshot, p, viewpoint, kMaxDistance);
    CHECK(match.has_value() == (best != nullptr));
    if (match && best != nullptr) {
      ++found;
      CHECK((match->q_map - best->q).norm() < kStoredM);
      CHECK(match->normal_map.dot(best->normal) > 0.9999F);
    }
  }
  CHECK(found > 200);
}

TEST_CASE(
    "the hash finds the plane of the point's own cell if the point is close to it, and otherwise the nearest "
    "plane that faces the robot") {
  std::mt19937 random(8);
  const std::vector<WorldPlane> planes = random_planes(random, 30'000);
  const auto snapshot = plane_hash_of(planes);
  REQUIRE(snapshot->plane_count() == planes.size());
  std::map<std::array<int, 3>, const WorldPlane*> by_cell;
  for (const WorldPlane& plane : planes) by_cell[{plane.cell.x(), plane.cell.y(), plane.cell.z()}] = &plane;
  std::uniform_real_distribution<double> place(-11.5, 11.5);
  int own = 0;
  int around = 0;
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d p = kFarAway + Eigen::Vector3d(place(random), place(random), place(random));
    if (i % 3 == 0) {  // near a plane, as most points of a scan are
      p = planes[static_cast<std::size_t>(i)].q +
          0.005 * Eigen::Vector3d(place(random), place(random), place(random));
    }
    const Eigen::Vector3d viewpoint = p + Eigen::Vector3d(place(random), place(random), place(random));
    const double max_distance = i % 2 == 0 ? 0.35 : 1.2;
    const LocalFrame frame(p, kCellM);
    const CellIndex cell = frame.cell_of(frame.to_local(p));
    const auto in_cell = by_cell.find({cell.x(), cell.y(), cell.z()});
    const WorldPlane* expected = nearest_of_all(planes, p, viewpoint, max_distance);
    if (in_cell != by_cell.end() && faces(*in_cell->second, viewpoint) &&
        (in_cell->second->q - p).norm() < max_distance && off_plane(*in_cell->second, p) < 0.05) {
      expected = in_cell->second;
      ++own;
    } else {
      around += expected != nullptr ? 1 : 0;
    }
    const auto match = nearest_match(*snapshot, p, viewpoint, max_distance);
    REQUIRE(match.has_value() == (expected != nullptr));
    if (expected != nullptr) {
      CHECK((match->q_map - expected->q).norm() < kStoredM);
      CHECK(match->normal_map.dot(expected->normal) > 0.9999F);
    }
  }
  CHECK(own > 100);
  CHECK(around > 500);
}

TEST_CASE("the cache of a matcher never changes its result") {
  std::mt19937 random(9);
  const std::vector<WorldPlane> planes = random_planes(random, 30'000);
  for (const auto& snapshot : {plane_hash_of(planes), nearest_plane_of(planes)}) {
    MatchQuery query;
    query.frame = LocalFrame(kFarAway, kCellM);
    query.viewpoint_local = query.frame.to_local(kFarAway + Eigen::Vector3d(1.0, 2.0, 3.0));
    std::uniform_real_distribution<float> place(-10.0F, 10.0F);
    std::normal_distribution<float> step(0.0F, 0.02F);
    std::vector<Eigen::Vector3f> points(500);
    for (Eigen::Vector3f& p : points) {
      p = query.frame.to_local(kFarAway) + Eigen::Vector3f(place(random), place(random), place(random));
    }
    std::vector<PlaneMatch> cached(points.size());
    for (int iteration = 0; iteration < 8; ++iteration) {
      query.max_distance_m = iteration < 3 ? 1.0F : 0.3F;
      std::vector<PlaneMatch> fresh(points.size());
      snapshot->match(query, points, cached);
      snapshot->match(query, points, fresh);
      for (std::size_t i = 0; i < points.size(); ++i) {
        REQUIRE(cached[i].found == fresh[i].found);
        if (!fresh[i].found) continue;
        CHECK(cached[i].q_local == fresh[i].q_local);
        CHECK(cached[i].normal == fresh[i].normal);
      }
      for (Eigen::Vector3f& p : points) p += Eigen::Vector3f(step(random), step(random), step(random));
    }
  }
}

TEST_CASE("an empty map matches no point") {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  CHECK_FALSE(nearest_match(MapSnapshot(), origin, origin, 10.0).has_value());
  CHECK(MapSnapshot().empty());
  CHECK_FALSE(nearest_match(*plane_hash_of({}), origin, origin, 2.0).has_value());
  CHECK_FALSE(nearest_match(*nearest_plane_of({}), origin, origin, 2.0).has_value());
}

}  // namespace isobar::test::test_map_snapshot

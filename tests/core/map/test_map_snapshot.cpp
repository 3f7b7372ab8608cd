// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <map>
#include <random>
#include <tuple>

#include "core/map/map_snapshot.hpp"

namespace {

using isobar::MapMatch;
using isobar::MapSnapshot;
using isobar::tile_of;
using isobar::TileIndex;
using isobar::TileKey;
using isobar::TilePlane;

struct WorldPlane {
  Eigen::Vector3d q;
  Eigen::Vector3f normal;
};

// Random planes over several tiles, far from the origin, where single precision in map coordinates would
// show.
std::vector<WorldPlane> random_planes(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-11.0, 11.0);
  std::normal_distribution<float> direction;
  std::vector<WorldPlane> planes;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3f normal(direction(random), direction(random), direction(random));
    planes.push_back({Eigen::Vector3d(place(random) + 8000.0, place(random) - 5000.0, place(random)),
                      normal.normalized()});
  }
  return planes;
}

MapSnapshot snapshot_of(const std::vector<WorldPlane>& planes) {
  std::map<std::tuple<int, int, int>, std::vector<TilePlane>> tiles;
  for (const WorldPlane& plane : planes) {
    const TileKey key = tile_of(plane.q);
    tiles[{key.x, key.y, key.z}].push_back({(plane.q - key.origin_map()).cast<float>(), plane.normal});
  }
  std::vector<std::shared_ptr<const TileIndex>> indices{nullptr};
  for (auto& [key, list] : tiles) {
    const TileKey tile{std::get<0>(key), std::get<1>(key), std::get<2>(key)};
    indices.push_back(std::make_shared<const TileIndex>(tile, std::move(list)));
  }
  return MapSnapshot(std::move(indices));
}

}  // namespace

TEST_CASE("the nearest facing plane is the one that a search through all finds") {
  std::mt19937 random(7);
  const std::vector<WorldPlane> planes = random_planes(random);
  const MapSnapshot snapshot = snapshot_of(planes);
  REQUIRE(snapshot.plane_count() == planes.size());
  std::uniform_real_distribution<double> place(-12.0, 12.0);
  constexpr double kMaxDistance = 1.2;
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p(place(random) + 8000.0, place(random) - 5000.0, place(random));
    const Eigen::Vector3d viewpoint = p + Eigen::Vector3d(place(random), place(random), place(random));
    double best = kMaxDistance;
    for (const WorldPlane& plane : planes) {
      const double distance = (plane.q - p).norm();
      if (distance < best && plane.normal.cast<double>().dot(viewpoint - plane.q) > 0.0) {
        best = distance;
      }
    }
    MapMatch match;
    const bool any = snapshot.nearest(p, viewpoint, kMaxDistance, match);
    CHECK(any == (best < kMaxDistance));
    if (any) {
      ++found;
      // Positions in a tile are floats up to 8 m: 1e-6 m.
      CHECK((match.q_map - p).norm() == doctest::Approx(best).epsilon(1e-5));
      CHECK(match.normal_map.cast<double>().dot(viewpoint - match.q_map) > 0.0);
    }
  }
  CHECK(found > 200);
}

TEST_CASE("an empty map matches nothing") {
  MapMatch match;
  CHECK_FALSE(MapSnapshot().nearest(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 10.0, match));
  CHECK(MapSnapshot().empty());
}

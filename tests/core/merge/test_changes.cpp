// SPDX-License-Identifier: BSD-3-Clause
// What has changed between two sessions: furniture that was taken away, and furniture that was put there.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/map/local_map.hpp"
#include "core/merge/building_merger.hpp"
#include "core/merge/later_session.hpp"
#include "tests/core/merge/ring_session.hpp"

namespace isobar::test::test_changes {
namespace {

/// Tiles in memory.
class MemoryTiles final : public TileStorage {
 public:
  bool put(const TileKey& key, std::span<const std::byte> bytes) override {
    tiles_[key].assign(bytes.begin(), bytes.end());
    return true;
  }
  bool take(const TileKey& key, std::vector<std::byte>& bytes) override {
    bytes = tiles_.at(key);
    return true;
  }
  [[nodiscard]] bool contains(const TileKey& key) const override { return tiles_.contains(key); }

 private:
  std::map<TileKey, std::vector<std::byte>> tiles_;
};

/// A cupboard at the inner wall of the southern corridor, 0.5 m deep: its front is at y = 0.7.
struct Cupboard {
  double west_m;
  double east_m;
};
constexpr Cupboard kTaken{4.0, 5.0};
constexpr Cupboard kPut{7.5, 8.5};
constexpr double kFrontM = 0.7;
constexpr double kWallM = 1.2;
constexpr double kHighM = 1.5;
// Below, rays that pass end on the floor, too near behind what was there.
constexpr double kLowM = 0.3;

World ring_with(const Cupboard& cupboard, double front_m = kFrontM) {
  World world = ring_of_corridors();
  world.add_box({cupboard.west_m, front_m, 0.0}, {cupboard.east_m, kWallM, kHighM});
  return world;
}

/// Surfaces that face south within a box across x and z: points of cells with a plane, their y [m].
std::vector<double> surfaces(const LocalMap& map, double west_m, double east_m, double south_m,
                             double north_m) {
  std::vector<MapPoint> points;
  map.append_points(points);
  std::vector<double> found;
  for (const MapPoint& point : points) {
    const Eigen::Vector3d p = point.p_map.cast<double>();
    const bool inside = p.x() > west_m && p.x() < east_m && p.y() > south_m && p.y() < north_m &&
                        p.z() > kLowM && p.z() < kHighM - 0.2;
    if (inside && point.normal_map.y() < -0.8F) found.push_back(p.y());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::size_t front_of(const LocalMap& map, const Cupboard& cupboard, double front_m = kFrontM) {
  return surfaces(map, cupboard.west_m, cupboard.east_m, front_m - 0.1, front_m + 0.1).size();
}

void lay(LocalMap& map, RingRun run, double until_m) {
  run.step_m = 0.25;  // rays through the place of a cupboard are few on a wider step
  while (run.way_m() < until_m) map.update(run.next());
}

/// Lays the key scans of some submaps.
void lay_keys(const JoinedBuildings& joined, BuildingStorage& scans, std::size_t first, std::size_t end,
              LocalMap& map) {
  const auto scan = std::make_unique<RegisteredScan>();
  for (std::size_t number = first; number < end; ++number) {
    for (const KeyScan& key : joined.building.submaps[number].keys) {
      REQUIRE(scans.read_scan(key.scan, *scan));
      scan->pose.stamp_ns = key.stamp_ns;
      scan->pose.T_map_base = key.T_map_base;
      map.update(*scan);
    }
  }
}

TEST_CASE("a later session clears what is gone and adds what is new, and walls stay where they were") {
  MemoryTiles tiles;
  LocalMap first({}, RingRun::lidar_mount(), &tiles);
  lay(first, RingRun({}, ring_with(kTaken)), 12.0);
  first.store_all();
  REQUIRE(front_of(first, kTaken) > 20);
  REQUIRE(front_of(first, kPut) == 0);
  const auto wall = [](const LocalMap& map) { return surfaces(map, 5.5, 7.0, kWallM - 0.1, kWallM + 0.1); };
  const std::vector<double> wall_before = wall(first);
  REQUIRE(wall_before.size() > 20);

  LocalMap second({}, RingRun::lidar_mount(), &tiles);
  second.load_around(ring_pose(0.0).translation());
  CHECK(front_of(second, kTaken) == front_of(first, kTaken));
  lay(second, RingRun({}, ring_with(kPut)), 12.0);
  CHECK(front_of(second, kTaken) == 0);
  CHECK(surfaces(second, kTaken.west_m + 0.2, kTaken.east_m - 0.2, kWallM - 0.1, kWallM + 0.1).size() > 10);
  CHECK(front_of(second, kPut) > 20);
  // Cells of the wall are frozen after 80 observations; those that were not go on to average the lidar's noise of 1 cm.
  const std::vector<double> wall_after = wall(second);
  CHECK(wall_after.size() >= wall_before.size());
  CHECK(wall_after[wall_after.size() / 2] ==
        doctest::Approx(wall_before[wall_before.size() / 2]).epsilon(0.005));
}

TEST_CASE("a shallow cupboard that is gone is cleared where the poses are those of a graph") {
  constexpr double kShallowM = kWallM - 0.3;
  MemoryTiles tiles;
  LocalMap first({}, RingRun::lidar_mount(), &tiles);
  lay(first, RingRun({}, ring_with(kTaken, kShallowM)), 12.0);
  first.store_all();
  REQUIRE(front_of(first, kTaken, kShallowM) > 20);
  LocalMap second(of_later_session({}), RingRun::lidar_mount(), &tiles);
  second.load_around(ring_pose(0.0).translation());
  lay(second, RingRun({}, ring_with(kPut)), 12.0);
  CHECK(front_of(second, kTaken, kShallowM) == 0);
  CHECK(front_of(second, kPut) > 20);
}

TEST_CASE("the same holds for a map that is laid anew from the key scans of two merged sessions") {
  RingSession a({.until_m = 42.0, .world = ring_with(kTaken)});
  RingSession b({.T_map_world = Eigen::Isometry3d(Eigen::Translation3d(2.0, 1.0, 0.3)),
                 .from_m = 36.0,
                 .until_m = 64.0,
                 .world = ring_with(kPut)});
  const MergeSide side_a = a.side();
  const MergeSide side_b = b.side();
  const KnownMap map_a = a.known_map();
  const MergedBuilding merged = BuildingMerger({}, side_a, map_a, side_b).run({-0.3, 0.3});
  REQUIRE(merged.problem.empty());
  JoinedScans scans(a.storage(), b.storage());
  MemoryTiles tiles;
  LocalMap first({}, RingRun::lidar_mount(), &tiles);
  lay_keys(merged.joined, scans, 0, merged.joined.submaps_of_a, first);
  first.store_all();
  REQUIRE(front_of(first, kTaken) > 20);
  LocalMap map(of_later_session({}), RingRun::lidar_mount(), &tiles);
  map.load_around(ring_pose(36.0).translation());
  lay_keys(merged.joined, scans, merged.joined.submaps_of_a, merged.joined.building.submaps.size(), map);
  CHECK(front_of(map, kTaken) == 0);
  CHECK(front_of(map, kPut) > 20);
}

}  // namespace
}  // namespace isobar::test::test_changes

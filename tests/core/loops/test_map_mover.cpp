// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <optional>
#include <vector>

#include "core/loops/building.hpp"
#include "core/loops/map_mover.hpp"
#include "core/loops/pose_corrections.hpp"
#include "core/loops/submap_maker.hpp"
#include "tests/core/loops/memory_storage.hpp"
#include "tests/core/loops/ring_run.hpp"

namespace isobar::test::test_map_mover {
namespace {

/// Dead reckoning goes wrong by 40 cm between 29 and 38 m, where no scan sees it.
Eigen::Isometry3d unseen(double way_m) {
  return way_m < 30.0 ? Eigen::Isometry3d::Identity()
                      : Eigen::Isometry3d(Eigen::Translation3d(0.3, 0.26, 0.0));
}

/// A run of more than a round: live map, building, and the map laid anew.
struct Round {
  RingRun run{unseen};
  MemoryStorage storage;
  MemoryTiles tiles;
  Building building{{}, {}, {}, RingRun::lidar_mount(), &storage};
  LocalMap live{{}, RingRun::lidar_mount()};
  MapMover mover{{}, {}, RingRun::lidar_mount(), storage};
  std::optional<MovedMap> moved;

  void drive(double until_m) {
    while (run.way_m() < until_m && !moved) {
      const RegisteredScan& scan = run.next();
      const bool changed = building.add(scan, AirHeight{0.6, 1e-4});
      live.update(scan);
      if (changed && mover.is_due(building)) mover.begin(building, tiles, 1);
      if (mover.active()) moved = mover.step(building, {});
    }
  }
  void drive_a_round() {
    drive(29.0);
    run.carry(9.0);
    drive(70.0);
  }
};

double share_on_walls(const LocalMap& map) {
  std::vector<MapPoint> points;
  map.append_points(points);
  return test::share_on_walls(points);
}

TEST_CASE(
    "a loop that closes 40 cm off moves the map: one wall where there were two, and the robot with it") {
  Round round;
  round.drive_a_round();
  REQUIRE(round.moved.has_value());
  // Cells of the live map hold both visits. Laid anew, all but those at corners are on a wall.
  const double before = share_on_walls(round.live);
  const double after = share_on_walls(*round.moved->map);
  CHECK(before < 0.85);
  CHECK(after > 0.95);
  // The robot: from where it believed to be to where it is.
  const Eigen::Isometry3d T = round.moved->T_now_before;
  CHECK((T * unseen(60.0)).translation().norm() < 0.05);
  CHECK(round.moved->map->move().number == 1);
  CHECK(round.moved->map->snapshot()->move().number == 1);
  CHECK(!round.tiles.tiles.empty());
}

TEST_CASE("poses and chain go on in the moved map: what is corrected stays, and nothing is due again") {
  Round round;
  round.drive_a_round();
  REQUIRE(round.moved.has_value());
  const Eigen::Isometry3d T = round.moved->T_now_before;
  round.building.expect_move(T);
  const double moved_way_m = round.run.way_m();
  for (int i = 0; i < 60; ++i) {
    RegisteredScan scan = round.run.next();
    scan.pose.T_map_base = T * scan.pose.T_map_base;
    scan.pose.map_moves = 1;
    round.building.add(scan, AirHeight{0.6, 1e-4});
  }
  CHECK(!round.mover.is_due(round.building));
  REQUIRE(round.building.moved_ns().size() == 1);
  const PoseCorrections corrections(round.building.corrections(), round.building.moved_ns());
  // Before, at and after the jump of the live poses.
  for (const double way_m : {20.0, moved_way_m - 0.4, moved_way_m, moved_way_m + 0.4, moved_way_m + 10.0}) {
    CAPTURE(way_m);
    const bool jumped = way_m > moved_way_m;
    const Eigen::Isometry3d live =
        (jumped ? T : Eigen::Isometry3d::Identity()) * unseen(way_m) * ring_pose(way_m);
    const std::int64_t stamp_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(way_m * 1e9);
    const Eigen::Isometry3d corrected = corrections.corrected(stamp_ns, live);
    // As without a move: some centimetres of chain and loops.
    CHECK((corrected.translation() - ring_pose(way_m).translation()).norm() < 0.05);
  }
}

TEST_CASE("a round without an error moves no map") {
  RingRun run;
  MemoryStorage storage;
  Building building({}, {}, {}, RingRun::lidar_mount(), &storage);
  const MapMover mover({}, {}, RingRun::lidar_mount(), storage);
  bool due = false;
  while (run.way_m() < 60.0) due = (building.add(run.next(), std::nullopt) && mover.is_due(building)) || due;
  REQUIRE(building.counts().taken > 0);
  CHECK(!due);
}

TEST_CASE("a map whose scans are lost is not moved, and says why") {
  Round round;
  round.storage.lost = false;
  round.drive(29.0);
  round.run.carry(9.0);
  while (!round.mover.active() && round.run.way_m() < 70.0) round.drive(round.run.way_m() + 0.4);
  REQUIRE(round.mover.active());
  round.storage.lost = true;
  round.drive(75.0);
  CHECK(!round.moved.has_value());
  CHECK(!round.mover.problem().empty());
  CHECK(!round.mover.is_due(round.building));
}

TEST_CASE("a submap that was forgotten is made anew as it was, plane by plane") {
  RingRun run;
  MemoryStorage storage;
  Building building({}, {}, {}, RingRun::lidar_mount(), &storage);
  while (run.way_m() < 35.0) building.add(run.next(), std::nullopt);
  const std::vector<Submap>& submaps = building.submaps();
  MapConfig map;
  map.radius_m = SubmapConfig{}.radius_m;
  SubmapMaker maker(map, RingRun::lidar_mount(), storage);
  for (std::size_t number = 0; number < 2; ++number) {
    REQUIRE(submaps[number].planes != nullptr);
    const auto again = maker.planes_of(submaps, number);
    REQUIRE(again != nullptr);
    // The second one grew beside the first, in which its first scans are held.
    CHECK(again->plane_count() == submaps[number].planes->plane_count());
  }
}

TEST_CASE("a building that is continued knows the places of the run before") {
  MemoryStorage storage;
  const LiveError found = [](double way_m) {
    return way_m < 30.0 ? Eigen::Isometry3d::Identity()
                        : Eigen::Isometry3d(Eigen::Translation3d(0.16, 0.12, 0.0));
  };
  RingRun run(found);
  {
    Building before({}, {}, {}, RingRun::lidar_mount(), &storage);
    while (run.way_m() < 29.0) before.add(run.next(), AirHeight{0.6, 1e-4});
  }
  const std::size_t submaps = storage.stored.submaps.size();
  REQUIRE(submaps == 3);
  Building after({}, {}, {}, RingRun::lidar_mount(), &storage);
  after.continue_from(storage.stored);
  CHECK(after.counts().submaps == submaps);
  // It was carried on meanwhile, and found its place in the old map to 20 cm.
  run.carry(9.0);
  while (run.way_m() < 60.0) after.add(run.next(), AirHeight{0.6, 1e-4});
  CHECK(after.counts().taken > 0);
  const PoseCorrections corrections(after.corrections());
  for (const double way_m : {20.0, 45.0, 58.0}) {
    const std::int64_t stamp_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(way_m * 1e9);
    const Eigen::Isometry3d corrected = corrections.corrected(stamp_ns, found(way_m) * ring_pose(way_m));
    CHECK((corrected.translation() - ring_pose(way_m).translation()).norm() < 0.05);
  }
}

}  // namespace
}  // namespace isobar::test::test_map_mover

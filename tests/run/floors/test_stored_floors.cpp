// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "core/map/local_map.hpp"
#include "run/files/text_file.hpp"
#include "run/floors/stored_floors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_stored_floors {

namespace {

// A hall 10 m x 10 m; the lidar is 1 m above its ground.
Eigen::Vector3f hit_in_hall(double azimuth, double elevation) {
  const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                          std::sin(elevation));
  double range = 5.0 / std::max(std::abs(d.x()), std::abs(d.y()));
  if (d.z() < 0.0) range = std::min(range, 1.0 / -d.z());
  return (range * d).cast<float>();
}

void store_hall(FileTileStore& store) {
  MapConfig config;
  config.cell_m = store.header().cell_m;
  LocalMap map(config, Eigen::Isometry3d::Identity(), &store);
  const auto scan = std::make_unique<RegisteredScan>();
  for (int s = 0; s < 20; ++s) {
    scan->pose = {};
    scan->pose.stamp_ns = (s + 1) * 1'000'000'000LL;
    scan->pose.mode = PoseMode::kRegistered;
    scan->pose.overlap = 1.0;
    scan->point_count = 0;
    for (int i = 0; i < 900; ++i) {
      for (int ring = 0; ring < 40; ++ring) {
        const Eigen::Vector3f p =
            hit_in_hall(0.4 * i * std::numbers::pi / 180.0, (ring - 30.0) * std::numbers::pi / 180.0);
        scan->points[scan->point_count++] = ScanPoint{p.x(), p.y(), p.z(), 0, 0, 50};
      }
    }
    map.update(*scan);
  }
  map.store_all();
}

}  // namespace

TEST_CASE("floors and grid come from the tiles of a stored map, also while it is being written") {
  const TemporaryFolder folder;
  MapHeader header;
  header.cell_m = 0.275;
  header.tile_m = 8.8;
  const auto writing = FileTileStore::create(folder.path() / "map", header, {});
  store_hall(*writing);
  const auto store = FileTileStore::open_to_read(folder.path() / "map");
  // base_link is the lidar, 1 m above the ground.
  std::vector<Eigen::Vector3d> path;
  for (int i = -30; i <= 30; ++i) path.emplace_back(0.1 * i, 0.0, 0.0);
  const files::StoredFloors found = files::find_stored_floors(*store, path);
  REQUIRE(found.floors.floors.size() == 1);
  CHECK(found.floors.floors[0].height_m == doctest::Approx(-1.0).epsilon(0.02));
  const OccupancyGrid grid = files::stored_floor_grid(*store, found, found.floors.floors[0], path, {});
  CHECK(std::max(grid.at({4.98, 1.0}), grid.at({5.02, 1.0})) == kCellOccupied);
  CHECK(std::max(grid.at({1.0, -4.98}), grid.at({1.0, -5.02})) == kCellOccupied);
  CHECK(grid.at({3.0, 2.0}) == kCellFree);
  CHECK(grid.at({5.3, 1.0}) == kCellUnknown);
}

TEST_CASE("the trajectory of a map is that of its frame, as estimated live; a comment alone is no path") {
  const TemporaryFolder folder;
  const auto run = folder.path();
  std::filesystem::create_directories(run / "map_2");
  CHECK(files::trajectory_of_map(run / "map").empty());
  files::write_text_file(run / "trajectory.tum", "# t\n1 2 3 4 0 0 0 1\n");
  files::write_text_file(run / "trajectory_2.tum", "# t\n");
  CHECK(files::trajectory_of_map(run / "map").filename() == "trajectory.tum");
  CHECK(files::trajectory_of_map(run / "map_2").filename() == "trajectory_2.tum");
  CHECK(files::trajectory_of_map(run / "other").empty());
  CHECK(files::path_of(run / "trajectory_2.tum").empty());
  REQUIRE(files::path_of(run / "trajectory.tum").size() == 1);
  CHECK(files::path_of(run / "trajectory.tum")[0].isApprox(Eigen::Vector3d(2.0, 3.0, 4.0)));
  files::write_text_file(run / "trajectory-corrected.tum", "1 2 3 5 0 0 0 1\n");
  CHECK(files::trajectory_of_map(run / "map").filename() == "trajectory.tum");
}

}  // namespace isobar::test::test_stored_floors

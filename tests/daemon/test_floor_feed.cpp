// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/floor_feed.hpp"

#include <doctest/doctest.h>

#include <map>
#include <memory>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_floor_feed {

namespace {

/// A scan of a wall of 8 x 4 m, 5 m in front of a robot at (x_m, 0, 0).
std::unique_ptr<RegisteredScan> wall_before(double x_m, std::int64_t stamp_ns) {
  auto scan = std::make_unique<RegisteredScan>();
  scan->pose = PoseEstimate{};
  scan->pose.mode = PoseMode::kRegistered;
  scan->pose.stamp_ns = stamp_ns;
  scan->pose.T_map_base.translation().x() = x_m;
  scan->point_count = 0;
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 32; ++column) {
      ScanPoint& point = scan->points[scan->point_count++];
      point = {};
      point.x_m = 5.1F;
      point.y_m = static_cast<float>((column - 15.5) * 0.25);
      point.z_m = static_cast<float>((row - 7.5) * 0.25);
    }
  }
  return scan;
}

/// A map of walls along x, whose tiles leave memory 20 m behind the robot.
class Drive {
 public:
  Drive()
      : store_(FileTileStore::create(folder_.path() / "map", {.tile_m = 8.8, .cell_m = 0.275}, {})),
        map_(config(), Eigen::Isometry3d::Identity(), store_.get()) {}

  void to(double x_m) {
    for (; x_m_ <= x_m; x_m_ += 4.0) map_.update(*wall_before(x_m_, stamp_ns_ += 1'000'000'000));
  }
  [[nodiscard]] LocalMap& map() { return map_; }
  FileTileStore* store() { return store_.get(); }
  [[nodiscard]] Eigen::Vector3d place() const { return {x_m_, 0.0, 0.0}; }

 private:
  static MapConfig config() {
    MapConfig config;
    config.radius_m = 20.0;
    config.see_through_limit = 0;
    return config;
  }
  TemporaryFolder folder_;
  std::unique_ptr<FileTileStore> store_;
  LocalMap map_;
  double x_m_ = 0.0;
  std::int64_t stamp_ns_ = 1'000'000'000'000;
};

/// Points by tile, of all that comes until the map is whole.
std::map<TileKey, std::size_t> whole(FloorFeed& feed, Drive& drive, int most_steps) {
  std::map<TileKey, std::size_t> tiles;
  for (int i = 0; i < most_steps; ++i) {
    feed.step(drive.map(), drive.store(), drive.place());
    const FloorTiles some = feed.take();
    for (const FloorTile& tile : some.tiles) {
      CHECK_FALSE(tiles.contains(tile.key));
      tiles[tile.key] = tile.points.size();
    }
    if (some.is_whole) return tiles;
  }
  FAIL("the map did not come whole");
  return tiles;
}

std::size_t points_of(const std::map<TileKey, std::size_t>& tiles) {
  std::size_t points = 0;
  for (const auto& [key, count] : tiles) points += count;
  return points;
}

}  // namespace

TEST_CASE("nothing comes before it is asked for, then every tile once: in memory and on the disk") {
  Drive drive;
  drive.to(100.0);
  const std::size_t in_memory = drive.map().tile_keys().size();
  REQUIRE(drive.store()->tile_count() > in_memory);
  FloorFeed feed;
  feed.step(drive.map(), drive.store(), drive.place());
  CHECK(feed.take().tiles.empty());
  feed.ask();
  const auto tiles = whole(feed, drive, 1'000);
  for (const TileKey& key : drive.map().tile_keys()) CHECK(tiles.contains(key));
  for (const TileKey& key : drive.store()->keys()) CHECK(tiles.contains(key));
  for (const auto& [key, points] : tiles) CHECK(points > 0);
  // The same points as an export of tiles in memory has.
  std::vector<MapPoint> memory;
  drive.map().append_points(memory);
  CHECK(points_of(tiles) > memory.size());
}

TEST_CASE("a tile on the disk comes again only after it was in memory in between") {
  Drive drive;
  drive.to(100.0);
  FloorFeed feed;
  feed.ask();
  const auto first = whole(feed, drive, 1'000);
  feed.ask();
  const auto second = whole(feed, drive, 1'000);
  CHECK(second.size() == drive.map().tile_keys().size());
  // Tiles that leave memory have changed since they were handed over.
  const std::vector<TileKey> before = drive.map().tile_keys();
  drive.to(160.0);
  feed.ask();
  const auto third = whole(feed, drive, 1'000);
  for (const TileKey& key : before) CHECK(third.contains(key));
  CHECK(third.size() < first.size() + before.size());
}

TEST_CASE("a map that was laid anew is handed over whole again, and says which it is") {
  Drive drive;
  drive.to(100.0);
  FloorFeed feed;
  feed.ask();
  const auto first = whole(feed, drive, 1'000);
  drive.map().set_move({1, Eigen::Isometry3d::Identity()});
  feed.ask();
  const auto again = whole(feed, drive, 1'000);
  CHECK(again.size() == first.size());
  feed.ask();
  feed.step(drive.map(), drive.store(), drive.place());
  CHECK(feed.take().map_moves == 1);
}

TEST_CASE("a step hands over one tile at least, the nearest first, and no more than its time allows") {
  Drive drive;
  drive.to(100.0);
  FloorFeed feed(0);
  feed.ask();
  feed.step(drive.map(), drive.store(), drive.place());
  const FloorTiles some = feed.take();
  REQUIRE(some.tiles.size() == 1);
  CHECK_FALSE(some.is_whole);
  const double x_m = 8.8 * (some.tiles.front().key.x + 0.5);
  CHECK(x_m > 90.0);
}

TEST_CASE("another map frame is handed over whole, and nothing of the one before is left in it") {
  Drive drive;
  drive.to(40.0);
  FloorFeed feed(0);
  feed.ask();
  feed.step(drive.map(), drive.store(), drive.place());  // one tile waits
  LocalMap next(MapConfig{}, Eigen::Isometry3d::Identity(), nullptr, 2);
  auto scan = wall_before(0.0, 1);
  scan->pose.session = 2;
  REQUIRE(next.update(*scan));
  for (std::size_t i = 0; i < next.tile_count(); ++i) feed.step(next, nullptr, Eigen::Vector3d::Zero());
  const FloorTiles tiles = feed.take();
  CHECK(tiles.session == 2);
  CHECK(tiles.is_whole);
  CHECK(tiles.tiles.size() == next.tile_count());
}

}  // namespace isobar::test::test_floor_feed

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "core/map/local_map.hpp"
#include "tests/core/map/nearest_match.hpp"

namespace isobar::test::test_local_map {

namespace {

using isobar::LocalMap;
using isobar::MapConfig;
using isobar::MapPoint;
using isobar::PoseMode;
using isobar::RegisteredScan;
using isobar::ScanPoint;

constexpr double kRoomM = 5.0;  // half the edge of a square room with the lidar in its centre

// Range to the walls of the room along a direction (no floor, no ceiling).
double range_to_walls(const Eigen::Vector3d& direction) {
  return kRoomM / std::max(std::abs(direction.x()), std::abs(direction.y()));
}

using RangeOf = std::function<double(const Eigen::Vector3d&)>;

// Scan of 16 rings by a robot at `x_m` on the x axis; `range_of`: range along a direction.
void fill_scan(RegisteredScan& scan, double x_m, std::int64_t stamp_ns, const RangeOf& range_of) {
  scan.pose = {};
  scan.pose.stamp_ns = stamp_ns;
  scan.pose.mode = PoseMode::kRegistered;
  scan.pose.overlap = 1.0;
  scan.pose.T_map_base.translation().x() = x_m;
  scan.point_count = 0;
  for (int i = 0; i < 900; ++i) {
    for (int ring = -15; ring <= 15; ring += 2) {
      const double azimuth = i * 2.0 * std::numbers::pi / 900.0;
      const double elevation = ring * std::numbers::pi / 180.0;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3f p = (direction * range_of(direction)).cast<float>();
      scan.points[scan.point_count++] = ScanPoint{p.x(), p.y(), p.z(), 0, 0, 0};
    }
  }
}

std::size_t points_within(const LocalMap& map, const Eigen::Vector3d& centre, double radius_m) {
  std::vector<MapPoint> points;
  map.append_points(points);
  std::size_t count = 0;
  for (const MapPoint& point : points) {
    count += (point.p_map - centre).norm() < radius_m ? 1 : 0;
  }
  return count;
}

// Tile storage in memory that counts the tiles read.
struct StorageInMemory final : isobar::TileStorage {
  bool put(const isobar::TileKey& key, std::span<const std::byte> bytes) override {
    ++put_count;
    if (full) return false;
    tiles[key].assign(bytes.begin(), bytes.end());
    return true;
  }
  bool take(const isobar::TileKey& key, std::vector<std::byte>& bytes) override {
    ++taken;
    bytes = tiles.at(key);
    return true;
  }
  [[nodiscard]] bool contains(const isobar::TileKey& key) const override { return tiles.contains(key); }
  std::map<isobar::TileKey, std::vector<std::byte>> tiles;
  std::size_t taken = 0;
  std::size_t put_count = 0;
  bool full = false;
};

// The room with a post of 0.4 m width at (x_m, 0), like a standing person.
RangeOf room_with_post(double x_m) {
  return [x_m](const Eigen::Vector3d& direction) {
    const double wall = range_to_walls(direction);
    const bool hits = direction.x() > 0.0 && std::abs(direction.y() / direction.x() * x_m) < 0.2;
    return hits ? std::min(wall, x_m / direction.x()) : wall;
  };
}

}  // namespace

TEST_CASE("on a rough surface a plane goes through the points of its own cell, on a smooth one through all") {
  // Waves of 4 cm: deeper than noise. The wall at +x, sampled densely.
  for (const double depth_m : {0.04, 0.0}) {
    CAPTURE(depth_m);
    LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
    auto scan = std::make_unique<RegisteredScan>();
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.008);
    const auto wall_m = [&](double y) { return kRoomM + 0.05 + depth_m * std::sin(6.0 * y); };
    fill_scan(*scan, 0.0, 0, range_to_walls);
    scan->point_count = 0;
    for (double y = -2.0; y < 2.0; y += 0.12) {
      for (double z = -1.0; z < 1.0; z += 0.12) {
        const auto x = static_cast<float>(wall_m(y) + noise(random));
        scan->points[scan->point_count++] =
            ScanPoint{x, static_cast<float>(y), static_cast<float>(z), 0, 0, 0};
      }
    }
    REQUIRE(map.update(*scan));
    double squared = 0.0;
    int count = 0;
    for (double y = -1.5; y < 1.5; y += 0.05) {
      const Eigen::Vector3d p(wall_m(y), y, 0.2);
      const auto match = nearest_match(*map.snapshot(), p, Eigen::Vector3d::Zero(), 0.3);
      if (!match) continue;
      const double off_m = match->normal_map.cast<double>().dot(p - match->q_map);
      squared += off_m * off_m;
      ++count;
    }
    REQUIRE(count > 40);
    CHECK(std::sqrt(squared / count) < (depth_m > 0.0 ? 0.012 : 0.0035));
  }
}

TEST_CASE("a wall is matched with its plane and the normal towards the robot") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<RegisteredScan>();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.015);
  for (int i = 0; i < 10; ++i) {
    fill_scan(*scan, 0.0, i * 2'000'000'000LL,
              [&](const Eigen::Vector3d& direction) { return range_to_walls(direction) + noise(random); });
    CHECK(map.update(*scan));
  }
  const Eigen::Vector3d beside_wall(kRoomM - 0.1, 1.0, 0.3);
  const auto match = nearest_match(*map.snapshot(), beside_wall, Eigen::Vector3d::Zero(), 0.5);
  REQUIRE(match.has_value());
  // Ten scans with 1.5 cm noise average to millimetres in position and about a degree in direction.
  CHECK(match->q_map.x() == doctest::Approx(kRoomM).epsilon(0.002));
  CHECK(match->normal_map.x() < -std::cos(3.0F * std::numbers::pi_v<float> / 180.0F));
  // Seen from behind the wall, no plane faces the viewpoint.
  CHECK_FALSE(nearest_match(*map.snapshot(), beside_wall, Eigen::Vector3d(20.0, 1.0, 0.3), 0.5).has_value());
}

TEST_CASE("the map of a robot at rest does not grow") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  map.update(*scan);
  const std::size_t once = points_within(map, Eigen::Vector3d::Zero(), 100.0);
  for (int i = 1; i < 50; ++i) {
    fill_scan(*scan, 0.0, i * 2'000'000'000LL, range_to_walls);
    map.update(*scan);
  }
  CHECK(once > 1000);
  CHECK(points_within(map, Eigen::Vector3d::Zero(), 100.0) == once);
}

TEST_CASE(
    "scans that follow each other closely insert shares of their points in turn; in a new place, all "
    "points") {
  MapConfig config;
  config.update_distance_m = 0.0;  // every scan is taken
  config.see_through_limit = 0;
  auto scan = std::make_unique<RegisteredScan>();
  // Number of cells after one scan in an empty map and `count` scans of another place, `interval_ns` apart.
  const auto cells_after = [&](int count, std::int64_t interval_ns, PoseMode mode, double overlap) {
    LocalMap map(config, Eigen::Isometry3d::Identity());
    fill_scan(*scan, 0.0, 0, range_to_walls);
    map.update(*scan);
    for (int i = 1; i <= count; ++i) {
      fill_scan(*scan, 50.0, i * interval_ns, range_to_walls);
      // Scaled to a room of 60 m, where few points share a cell: in the room of 10 m most do.
      for (ScanPoint& p : std::span(scan->points).first(scan->point_count)) {
        p = {6 * p.x_m, 6 * p.y_m, 6 * p.z_m, 0, 0, 0};
      }
      scan->pose.mode = mode;
      scan->pose.overlap = overlap;
      map.update(*scan);
    }
    return map.cell_count();
  };
  constexpr std::int64_t kMs = 1'000'000;
  const std::size_t first = cells_after(0, 0, PoseMode::kRegistered, 0.9);
  const std::size_t whole = cells_after(1, 1000 * kMs, PoseMode::kRegistered, 0.9) - first;
  const std::size_t half = cells_after(1, 100 * kMs, PoseMode::kRegistered, 0.9) - first;
  const std::size_t quarter = cells_after(1, 50 * kMs, PoseMode::kRegistered, 0.9) - first;
  REQUIRE(whole > 5'000);
  // Some cells contain two or three points, so that half of the points fill more than half of the cells.
  CHECK(half < 7 * whole / 10);
  CHECK(half > 4 * whole / 10);
  CHECK(quarter < half);
  CHECK(cells_after(2, 100 * kMs, PoseMode::kRegistered, 0.9) - first == whole);
  CHECK(cells_after(4, 50 * kMs, PoseMode::kRegistered, 0.9) - first == whole);
  // All points are inserted in a new place, and when the pose is that of the prior alone.
  CHECK(cells_after(1, 100 * kMs, PoseMode::kRegistered, 0.3) - first == whole);
  CHECK(cells_after(1, 100 * kMs, PoseMode::kPriorOnly, 0.9) - first == whole);
  // Negative time since the last scan, after the clock was set back.
  CHECK(cells_after(1, -100 * kMs, PoseMode::kRegistered, 0.9) - first == whole);
}

TEST_CASE("cells that rays pass through are removed from the map; the walls stay") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, room_with_post(3.0));
  map.update(*scan);
  const Eigen::Vector3d post(3.0, 0.0, 0.0);
  REQUIRE(points_within(map, post, 0.5) > 10);
  fill_scan(*scan, 0.0, 0, range_to_walls);
  const std::size_t walls = points_within(map, Eigen::Vector3d(-kRoomM, 0.0, 0.0), 2.0);
  for (int i = 1; i < 8; ++i) {
    fill_scan(*scan, 0.0, i * 2'000'000'000LL, range_to_walls);
    map.update(*scan);
  }
  CHECK(points_within(map, post, 0.5) == 0);
  CHECK(points_within(map, Eigen::Vector3d(-kRoomM, 0.0, 0.0), 2.0) >= walls);
  CHECK_FALSE(nearest_match(*map.snapshot(), post, Eigen::Vector3d::Zero(), 0.5).has_value());
  CHECK(map.seen_through_count() > 0);
}

TEST_CASE("tiles beyond the radius move to the storage, and memory stays bounded on a long way") {
  MapConfig config;
  config.radius_m = 20.0;
  StorageInMemory storage;
  LocalMap map(config, Eigen::Isometry3d::Identity(), &storage);
  auto scan = std::make_unique<RegisteredScan>();
  std::size_t most_tiles = 0;
  constexpr int kWayM = 100;  // five times the radius
  for (int i = 0; i <= kWayM; ++i) {
    fill_scan(*scan, i * 1.0, i * 1'000'000'000LL, range_to_walls);
    map.update(*scan);
    most_tiles = std::max(most_tiles, map.tile_count());
  }
  // A ball of 20 m plus one tile has at most (2 * 28 / 8 + 1)^3 tiles, of which a flat world fills two
  // layers.
  CHECK(most_tiles < 128);
  std::vector<MapPoint> stored;
  for (const auto& [key, bytes] : storage.tiles) {
    CHECK(isobar::MapTile::append_stored_points(bytes, stored));
  }
  REQUIRE(stored.size() > 1000);
  double nearest = 1e9;
  for (const MapPoint& point : stored) {
    nearest = std::min(nearest, kWayM - point.p_map.x());
  }
  CHECK(nearest > config.radius_m - 8.0);  // minus the width of a tile
}

TEST_CASE("a robot that returns finds the map that it left, and the storage is not read in between") {
  MapConfig config;
  config.radius_m = 20.0;
  StorageInMemory storage;
  LocalMap map(config, Eigen::Isometry3d::Identity(), &storage);
  auto scan = std::make_unique<RegisteredScan>();
  std::int64_t stamp_ns = 0;
  const auto go_to = [&](double x_m) {
    fill_scan(*scan, x_m, stamp_ns += 1'000'000'000, range_to_walls);
    map.update(*scan);
  };
  for (int i = 0; i < 5; ++i) go_to(0.0);
  const Eigen::Vector3d wall(-kRoomM, 0.0, 0.0);
  const std::size_t points = points_within(map, wall, 4.0);
  const auto match_wall = [&] {
    std::vector<NearestMatch> matches;
    for (double y = -4.0; y <= 4.0; y += 0.3) {
      const Eigen::Vector3d p(-kRoomM + 0.05, y, 0.2);
      const auto match = nearest_match(*map.snapshot(), p, Eigen::Vector3d::Zero(), 0.4);
      if (match) matches.push_back(*match);
    }
    return matches;
  };
  const auto before = match_wall();
  REQUIRE(before.size() > 10);
  for (double x = 8.0; x < 80.0; x += 8.0) go_to(x);
  REQUIRE(points_within(map, wall, 4.0) == 0);
  const std::size_t taken = storage.taken;
  go_to(80.0);
  CHECK(storage.taken == taken);
  // 17 m from the wall, whose tiles are within the radius again; the new scans do not reach it.
  for (int i = 0; i < 8; ++i) go_to(12.0);
  CHECK(points_within(map, wall, 4.0) == points);
  const auto after = match_wall();
  REQUIRE(after.size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(after[i].q_map == before[i].q_map);
    CHECK(after[i].normal_map == before[i].normal_map);
  }
}

TEST_CASE("points in a stored tile are added to it, even if the map has not brought it back yet") {
  MapConfig config;
  config.radius_m = 20.0;
  StorageInMemory storage;
  LocalMap map(config, Eigen::Isometry3d::Identity(), &storage);
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  map.update(*scan);
  const std::size_t points = points_within(map, Eigen::Vector3d(-kRoomM, 0.0, 0.0), 3.0);
  fill_scan(*scan, 60.0, 1'000'000'000, range_to_walls);
  map.update(*scan);
  // One long ray back along the x axis ends on the wall that was seen from x = 0.
  scan->pose.T_map_base.translation().x() = 13.0;
  scan->pose.stamp_ns += 1'000'000'000;
  scan->point_count = 1;
  scan->points[0] = ScanPoint{-18.0F, 0.1F, 0.1F, 0, 0, 0};
  map.update(*scan);
  CHECK(points_within(map, Eigen::Vector3d(-kRoomM, 0.0, 0.0), 3.0) >= points);
}

TEST_CASE("a damaged tile is dropped and its place is mapped anew") {
  MapConfig config;
  config.radius_m = 20.0;
  StorageInMemory storage;
  LocalMap map(config, Eigen::Isometry3d::Identity(), &storage);
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  map.update(*scan);
  fill_scan(*scan, 80.0, 1'000'000'000, range_to_walls);
  map.update(*scan);
  for (auto& [key, bytes] : storage.tiles) bytes.resize(bytes.size() - 1);
  fill_scan(*scan, 0.0, 2'000'000'000, range_to_walls);
  map.update(*scan);
  CHECK(storage.taken > 0);
  CHECK(points_within(map, Eigen::Vector3d::Zero(), 8.0) > 1000);
}

TEST_CASE("a snapshot does not change when the map does, and unchanged tiles are shared") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  map.update(*scan);
  const auto before = map.snapshot();
  const std::size_t planes = before->plane_count();
  fill_scan(*scan, 30.0, 1'000'000'000, range_to_walls);
  map.update(*scan);
  CHECK(before->plane_count() == planes);
  CHECK(map.snapshot()->plane_count() > planes);
}

TEST_CASE("a scan whose pose is that of the prior alone adds points only where the map has none") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  map.update(*scan);
  const std::size_t known = points_within(map, Eigen::Vector3d(-kRoomM, 0.0, 0.0), 1.5);
  // Shifted by 0.3 m, it would double every wall perpendicular to x.
  fill_scan(*scan, 0.3, 1'000'000'000, range_to_walls);
  scan->pose.mode = PoseMode::kPriorOnly;
  map.update(*scan);
  CHECK(points_within(map, Eigen::Vector3d(-kRoomM, 0.0, 0.0), 1.5) == known);
  fill_scan(*scan, 40.0, 2'000'000'000, range_to_walls);
  scan->pose.mode = PoseMode::kPriorOnly;
  map.update(*scan);
  CHECK(points_within(map, Eigen::Vector3d(40.0 - kRoomM, 0.0, 0.0), 1.5) > known / 2);
}

TEST_CASE("a scan with a non-finite pose is refused") {
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  scan->pose.T_map_base.translation().y() = std::nan("");
  CHECK_FALSE(map.update(*scan));
  CHECK(map.cell_count() == 0);
}

TEST_CASE("changed tiles reach the storage within a sweep, unchanged ones are not written again") {
  StorageInMemory storage;
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity(), &storage);
  const auto scan = std::make_unique<RegisteredScan>();
  for (int i = 0; i < 5; ++i) {
    fill_scan(*scan, 0.2 * i, 1'000'000'000LL * i, range_to_walls);
    map.update(*scan);
  }
  for (std::size_t i = 0; i < LocalMap::kSweepParts; ++i) map.store_some();
  CHECK(storage.tiles.size() == map.tile_count());
  const std::size_t written = storage.put_count;
  for (std::size_t i = 0; i < 2 * LocalMap::kSweepParts; ++i) map.store_some();
  CHECK(storage.put_count == written);
  fill_scan(*scan, 1.2, 6'000'000'000LL, range_to_walls);
  map.update(*scan);
  for (std::size_t i = 0; i < LocalMap::kSweepParts; ++i) map.store_some();
  CHECK(storage.put_count > written);
}

TEST_CASE("tiles that a full disk refuses are written when it has room") {
  StorageInMemory storage;
  storage.full = true;
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity(), &storage);
  const auto scan = std::make_unique<RegisteredScan>();
  fill_scan(*scan, 0.0, 0, range_to_walls);
  map.update(*scan);
  for (std::size_t i = 0; i < LocalMap::kSweepParts; ++i) map.store_some();
  CHECK(storage.put_count == LocalMap::kSweepParts);  // one attempt a call
  storage.full = false;
  for (std::size_t i = 0; i < LocalMap::kSweepParts; ++i) map.store_some();
  CHECK(storage.tiles.size() == map.tile_count());
}

TEST_CASE("a map that is read around a place has the planes that were stored, before any scan") {
  StorageInMemory storage;
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity(), &storage);
  const auto scan = std::make_unique<RegisteredScan>();
  for (int i = 0; i < 5; ++i) {
    fill_scan(*scan, 0.2 * i, 1'000'000'000LL * i, range_to_walls);
    map.update(*scan);
  }
  map.store_all();
  LocalMap continued(MapConfig{}, Eigen::Isometry3d::Identity(), &storage, 3);
  CHECK(continued.snapshot()->empty());
  continued.load_around(Eigen::Vector3d(0.5, 0.0, 0.0));
  CHECK(continued.snapshot()->plane_count() == map.snapshot()->plane_count());
  CHECK(continued.snapshot()->session() == 3);
  CHECK_FALSE(continued.update(*scan));  // a scan of frame 1
  scan->pose.session = 3;
  scan->pose.stamp_ns += 2'000'000'000LL;
  CHECK(continued.update(*scan));
}

}  // namespace isobar::test::test_local_map

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/map/grid.hpp"
#include "core/map/local_map.hpp"
#include "run/building/building_store.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tests/core/merge/ring_session.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"
#include "tests/support/exit_code.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_map_merge_command {
namespace {

namespace fs = std::filesystem;

int map_command(const std::vector<std::string>& words) {
  std::vector<std::string> all{"map"};
  all.insert(all.end(), words.begin(), words.end());
  return isobar::test::exit_code(tools::add_map_command, all);
}

/// The folder of a run through the ring.
std::string put_run(const fs::path& folder, const RingSessionWish& wish) {
  const MapConfig config;
  const auto tiles = FileTileStore::create(
      folder / "map", {.tile_m = kTileCells * config.cell_m, .cell_m = config.cell_m}, {});
  const auto building = BuildingStore::open_to_continue(folder / "map", 1U << 30);
  LocalMap map(config, RingRun::lidar_mount(), tiles.get());
  drive_ring(wish, *building, map);
  map.store_all();
  write_content(folder / "settings.toml", "lidar.xyz_m = [0.0, 0.0, 0.2]\n");
  return folder.string();
}

const Eigen::Isometry3d kFrameOfB(Eigen::Translation3d(3.0, -7.0, 0.4));

TEST_CASE("two runs through one building become a map that the other commands read") {
  const Scratch scratch;
  const std::string a = put_run(scratch.path() / "a", {.until_m = 42.0});
  const std::string b =
      put_run(scratch.path() / "b", {.T_map_world = kFrameOfB, .from_m = 15.0, .until_m = 42.0});
  write_content(scratch.path() / "b/map/floors.toml", "[[floor]]\nheight_m = 0.4\nname = \"Ground\"\n");
  const std::string c = scratch.path() / "c";
  const std::string log_before = content_of(scratch.path() / "a/map/building/building.log");
  REQUIRE(map_command({"merge", a, b + "/map", "--out", c}) == 0);
  CHECK(content_of(scratch.path() / "a/map/building/building.log") == log_before);
  CHECK_FALSE(fs::exists(c + ".part"));
  CHECK(map_command({"info", c}) == 0);
  CHECK(map_command({"check", c}) == 0);
  CHECK(map_command({"floors", c}) == 0);
  CHECK(content_of(c + "/map/floors.toml").find("\"Ground\"") !=
        std::string::npos);  // at its height in A: 0 m
  CHECK(map_command({"grid", c, "--out", c + "/grids"}) == 0);
  // The building goes on: all submaps and key scans of both are in its log, with their points.
  const auto joined = BuildingStore::open_to_read(c + "/map");
  REQUIRE(joined != nullptr);
  const auto submaps_of = [](const std::string& run) {
    return BuildingStore::open_to_read(run + "/map")->stored().submaps.size();
  };
  CHECK(joined->stored().submaps.size() == submaps_of(a) + submaps_of(b));
  const auto scan = std::make_unique<RegisteredScan>();
  for (const Submap& submap : joined->stored().submaps) {
    for (const KeyScan& key : submap.keys) CHECK(joined->read_scan(key.scan, *scan));
  }
  // A folder that holds something is left alone.
  CHECK(map_command({"merge", a, b, "--out", c}) == 64);
  CHECK(map_command({"merge", a, a, "--out", c + "2"}) == 64);
}

TEST_CASE("a map without key scans, and one that does not fit, are said, and nothing is written") {
  const Scratch scratch;
  const std::string a = put_run(scratch.path() / "a", {.until_m = 8.0});
  const std::string c = scratch.path() / "c";
  const std::string tiles_alone = scratch.path() / "old";
  REQUIRE(FileTileStore::create(scratch.path() / "old/map", {}, {}) != nullptr);
  CHECK(map_command({"merge", a, tiles_alone, "--out", c}) == 65);
  CHECK(map_command({"merge", tiles_alone, a, "--out", c}) == 65);
  CHECK(map_command({"merge", a, scratch.path().string(), "--out", c}) == 65);
  // The other end of the ring: no place of the first is in it.
  const std::string b = put_run(scratch.path() / "b", {.from_m = 23.0, .until_m = 29.0});
  CHECK(map_command({"merge", a, b, "--out", c}) == 65);
  CHECK_FALSE(fs::exists(c));
  CHECK_FALSE(fs::exists(c + ".part"));
}

}  // namespace
}  // namespace isobar::test::test_map_merge_command

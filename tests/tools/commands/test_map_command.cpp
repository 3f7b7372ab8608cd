// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/errors.hpp"
#include "core/map/map_tile.hpp"
#include "run/files/map_export.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"
#include "tests/support/exit_code.hpp"
#include "tools/commands.hpp"
#include "tools/map_parts.hpp"

namespace isobar::test::test_map_command {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

int map_command(const std::vector<std::string>& words) {
  std::vector<std::string> all{"map"};
  all.insert(all.end(), words.begin(), words.end());
  return isobar::test::exit_code(tools::add_map_command, all);
}

/// Stores three tiles without points; the commands do not depend on the points.
void put_tiles(FileTileStore& store) {
  Bytes bytes;
  for (int n = 0; n < 3; ++n) {
    const TileKey key{n, 0, 0};
    MapTile(key).store(0.25F, bytes);
    REQUIRE(store.put(key, bytes));
  }
}

}  // namespace

TEST_CASE("an undamaged map passes info, check and export, by its own folder and by the run's") {
  const Scratch scratch;
  const std::string run = scratch.path().string();
  { put_tiles(*FileTileStore::create(scratch.path() / "map", {}, {})); }
  const std::string ply = run + "/x.ply";
  for (const std::string& folder : {run, run + "/map"}) {
    CHECK(map_command({"info", folder}) == 0);
    CHECK(map_command({"check", folder}) == 0);
    CHECK(map_command({"export", folder, "--out", ply}) == 0);
  }
  CHECK(content_of(ply).starts_with("ply\n"));
  CHECK(map_command({"export", run, "--out", ply, "--box", "0", "0", "0", "1", "1", "1"}) == 0);
}

TEST_CASE("a damaged map exits with 65, an output file that cannot be written with 69") {
  const Scratch scratch;
  const std::string folder = scratch.path().string();
  {
    const auto store = FileTileStore::create(scratch.path(), {}, {});
    put_tiles(*store);
  }
  CHECK(map_command({"export", folder, "--out", folder + "/missing/x.ply"}) == 69);
  std::string tiles = content_of(scratch.path() / "00000000.tiles");
  tiles[sizeof(RecordHead) + 1] = static_cast<char>(tiles[sizeof(RecordHead) + 1] ^ 1);
  write_content(scratch.path() / "00000000.tiles", tiles);
  CHECK(map_command({"info", folder}) == 0);
  CHECK(map_command({"check", folder}) == 65);
  CHECK(map_command({"export", folder, "--out", folder + "/x.ply"}) == 65);
}

TEST_CASE("check counts a tile that cannot be decoded as damage") {
  const Scratch scratch;
  { REQUIRE(FileTileStore::create(scratch.path(), {}, {})->put({}, Bytes(100))); }
  CHECK(map_command({"check", scratch.path().string()}) == 65);
}

TEST_CASE("a folder without a map and a box with swapped corners are refused") {
  const Scratch scratch;
  const std::string folder = scratch.path().string();
  CHECK(map_command({"info", folder}) == 65);
  { put_tiles(*FileTileStore::create(scratch.path(), {}, {})); }
  CHECK(map_command({"export", folder, "--out", folder + "/x.ply", "--box", "0", "0", "0", "1", "-1", "1"}) ==
        64);
  CHECK(map_command({"export", folder, "--out", folder + "/x.ply", "--box", "0", "0"}) == 64);
  CHECK(map_command({"export", folder}) == 64);
  CHECK(map_command({}) == 64);
}

TEST_CASE("export takes the format from the ending and refuses another one before it writes") {
  const Scratch scratch;
  const std::string folder = scratch.path().string();
  { put_tiles(*FileTileStore::create(scratch.path(), {}, {})); }
  CHECK(map_command({"export", folder, "--out", folder + "/x.pcd"}) == 0);
  CHECK(map_command({"export", folder, "--out", folder + "/x.las"}) == 0);
  CHECK(content_of(folder + "/x.pcd").find("POINTS 0\n") != std::string::npos);
  CHECK(content_of(folder + "/x.las").starts_with("LASF"));
  CHECK(map_command({"export", folder, "--out", folder + "/x.laz"}) == 64);
  CHECK_FALSE(std::filesystem::exists(folder + "/x.laz.part"));
}

TEST_CASE("floors and grid of a run take the path from its trajectory, and names from floors.toml") {
  const Scratch scratch;
  const std::string run = scratch.path().string();
  { put_tiles(*FileTileStore::create(scratch.path() / "map", {}, {})); }
  CHECK(map_command({"floors", run}) == 0);  // nothing says that there is a floor
  CHECK(map_command({"grid", run, "--out", run + "/grids"}) == 65);
  write_content(scratch.path() / "trajectory.tum", "1 2 3 4 0 0 0 1\n2 3 3 4 0 0 0 1\n");
  CHECK(map_command({"floors", run, "--name", "0=Ground floor"}) == 0);
  CHECK(content_of(run + "/map/floors.toml").find("height_m = 4.00\nname = \"Ground floor\"") !=
        std::string::npos);
  CHECK(map_command({"floors", run, "--json"}) == 0);
  CHECK(map_command({"grid", run, "--floor", "Ground floor", "--out", run + "/grids"}) == 0);
  CHECK(content_of(run + "/grids/floor_0.yaml").find("image: floor_0.pgm\n") != std::string::npos);
  CHECK(
      content_of(run + "/grids/floor_0.pgm").starts_with("P5\n# isobar: floor 0 at 4.00 m, Ground floor\n"));
  for (const char* floor : {"0", "Ground floor"})
    CHECK(tools::base_height_on(run, floor) == doctest::Approx(4.0));
  CHECK_THROWS_WITH_AS(static_cast<void>(tools::base_height_on(run, "Cellar")),
                       "'Cellar' is no floor of this map; it has 0 (Ground floor)", UsageError);
  CHECK(map_command({"grid", run, "--floor", "7", "--out", run + "/grids"}) == 64);
  CHECK(map_command({"floors", run, "--name", "Cellar"}) == 64);
  CHECK(map_command({"floors", run, "--name", "3=Cellar"}) == 64);
  write_content(scratch.path() / "map/floors.toml", "[[floor]]\nname = \"A\"\n");
  CHECK(map_command({"floors", run}) == 65);
}

}  // namespace isobar::test::test_map_command

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/map/map_tile.hpp"
#include "run/files/map_export.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"
#include "tests/support/exit_code.hpp"
#include "tools/commands.hpp"

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

}  // namespace isobar::test::test_map_command

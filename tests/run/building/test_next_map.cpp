// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <memory>

#include "run/building/next_map.hpp"
#include "tests/run/tile_store/tiles.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_next_map {
namespace {

namespace fs = std::filesystem;

const MapHeader kHeader{8.8, 0.275};
const TileKey kKey{1, 2, 3};

/// A map with a tile, a building and names of floors, and beside it the next one, complete.
fs::path two_maps(const fs::path& folder) {
  const fs::path map = folder / "map";
  const auto put = [](FileTileStore& store, std::uint32_t version) {
    const Bytes bytes = tile_bytes(kKey, version, 100);
    REQUIRE(store.put(kKey, bytes));
  };
  put(*FileTileStore::create(map, kHeader, {}), 1);
  fs::create_directories(map / kBuildingFolder);
  write_content(map / kBuildingFolder / "building.log", "log");
  write_content(map / "floors.toml", "names");
  write_content(map / "00000003.scans", "journal of the old map");
  put(*create_next_map(map, kHeader, {}), 2);
  complete_next_map(map);
  return map;
}

bool is_next(const fs::path& map) {
  Bytes bytes;
  const auto store = FileTileStore::open_to_read(map);
  return store->take(kKey, bytes) && bytes == tile_bytes(kKey, 2, 100);
}

void check_settled(const fs::path& map) {
  CHECK(is_next(map));
  CHECK(content_of(map / kBuildingFolder / "building.log") == "log");
  CHECK(content_of(map / "floors.toml") == "names");
  CHECK(!fs::exists(map / "00000003.scans"));
  CHECK(!fs::exists(map / "complete"));
  CHECK(!fs::exists(map.string() + ".next"));
  CHECK(!fs::exists(map.string() + ".old"));
}

TEST_CASE("a complete next map takes the place of the map, with building and names of floors") {
  const TemporaryFolder folder;
  const fs::path map = two_maps(folder.path());
  CHECK(settle_next_map(map));
  check_settled(map);
  CHECK(!settle_next_map(map));
  check_settled(map);
}

TEST_CASE("an exchange that was interrupted after any step is carried out by the next start") {
  for (int steps = 1; steps <= 4; ++steps) {
    CAPTURE(steps);
    const TemporaryFolder folder;
    const fs::path map = two_maps(folder.path());
    const fs::path next = map.string() + ".next";
    if (steps >= 1) fs::rename(map / kBuildingFolder, next / kBuildingFolder);
    if (steps >= 2) fs::rename(map / "floors.toml", next / "floors.toml");
    if (steps >= 3) fs::rename(map, map.string() + ".old");
    if (steps >= 4) fs::rename(next, map);
    settle_next_map(map);
    CHECK(is_next(map));
    CHECK(content_of(map / kBuildingFolder / "building.log") == "log");
    CHECK(content_of(map / "floors.toml") == "names");
    CHECK(!fs::exists(map.string() + ".old"));
  }
}

TEST_CASE("a next map that was removed takes nobody's place") {
  const TemporaryFolder folder;
  const fs::path map = two_maps(folder.path());
  remove_next_map(map);
  CHECK(!settle_next_map(map));
  CHECK(!is_next(map));
}

TEST_CASE("a next map that is not complete is removed, and the map stays") {
  const TemporaryFolder folder;
  const fs::path map = two_maps(folder.path());
  fs::remove(fs::path(map.string() + ".next") / "complete");
  CHECK(!settle_next_map(map));
  CHECK(!is_next(map));
  CHECK(fs::exists(map / "00000003.scans"));
  CHECK(!fs::exists(map.string() + ".next"));
}

}  // namespace
}  // namespace isobar::test::test_next_map

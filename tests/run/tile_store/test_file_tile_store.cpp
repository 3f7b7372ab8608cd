// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <map>
#include <random>

#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"

namespace isobar::test::test_file_tile_store {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

/// Puts 4000 tiles with 60 keys in random order and sizes; returns the newest version of each key.
std::map<TileKey, Bytes> fill(FileTileStore& store, unsigned seed) {
  std::mt19937 random(seed);
  std::map<TileKey, Bytes> expected;
  for (std::uint32_t version = 0; version < 4'000; ++version) {
    const TileKey key = key_number(static_cast<int>(random() % 60));
    Bytes bytes = tile_bytes(key, version, 1 + random() % (version % 50 == 0 ? 60'000 : 1'500));
    REQUIRE(store.put(key, bytes));
    expected[key] = std::move(bytes);
  }
  return expected;
}

void check_holds(FileTileStore& store, const std::map<TileKey, Bytes>& expected) {
  std::vector<TileKey> keys;
  Bytes bytes;
  for (const auto& [key, content] : expected) {
    keys.push_back(key);
    CHECK(store.contains(key));
    REQUIRE(store.take(key, bytes));
    CHECK(bytes == content);
  }
  CHECK(store.keys() == keys);
  const TileKey unknown{1'000, 0, 0};
  CHECK_FALSE(store.contains(unknown));
  CHECK_FALSE(store.take(unknown, bytes));
  CHECK(bytes.empty());
}

}  // namespace

TEST_CASE("a store returns the newest version of every tile") {
  const Scratch scratch;
  const auto store = FileTileStore::create(scratch.path() / "map", {}, {});
  check_holds(*store, fill(*store, 1));
  CHECK(store->counters().damaged == 0);
  CHECK(store->counters().refused == 0);
}

TEST_CASE("tiles survive closing and reopening, read-only and for writing, with and without the index") {
  const Scratch scratch;
  TileStoreLimits limits;
  limits.max_bytes = 16U << 20U;  // gives segments of 256 KiB, so that the map has several
  std::map<TileKey, Bytes> expected;
  {
    const auto store = FileTileStore::create(scratch.path(), {}, limits);
    expected = fill(*store, 2);
    for (int n = 0; n < 300; ++n) {
      const TileKey key{n, 500, 0};
      expected[key] = tile_bytes(key, 1, 3'000);
      REQUIRE(store->put(key, expected[key]));
    }
    REQUIRE(store->segment_count() > 1);
  }
  check_holds(*FileTileStore::open_to_read(scratch.path()), expected);
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path())) {
    if (entry.path().extension() == ".index") std::filesystem::remove(entry.path());
  }
  check_holds(*FileTileStore::open_to_read(scratch.path()), expected);
  {
    const auto store = FileTileStore::open_to_continue(scratch.path(), {}, limits);
    check_holds(*store, expected);
    CHECK(store->counters().torn == 0);
    CHECK(store->counters().damaged == 0);
    expected[key_number(5)] = tile_bytes(key_number(5), 9'999, 777);
    REQUIRE(store->put(key_number(5), expected[key_number(5)]));
    check_holds(*store, expected);
  }
  check_holds(*FileTileStore::open_to_read(scratch.path()), expected);
}

TEST_CASE("a map can be read while another store writes it") {
  const Scratch scratch;
  const auto writer = FileTileStore::create(scratch.path(), {}, {});
  const auto expected = fill(*writer, 3);
  check_holds(*FileTileStore::open_to_read(scratch.path()), expected);
  CHECK_FALSE(FileTileStore::open_to_read(scratch.path())->put({}, Bytes(10)));
}

TEST_CASE("an empty tile and one larger than half of the disk limit are refused and counted") {
  const Scratch scratch;
  TileStoreLimits limits;
  limits.max_bytes = 1U << 20U;
  const auto store = FileTileStore::create(scratch.path(), {}, limits);
  CHECK_FALSE(store->put({}, {}));
  CHECK_FALSE(store->put({}, Bytes(600'000)));
  CHECK(store->counters().refused == 2);
  CHECK(store->counters().first_refusal.find("a tile of 0 bytes") != std::string::npos);
  CHECK(store->put({}, Bytes(400'000)));
}

TEST_CASE("creating a map deletes the old one and no other file of the folder") {
  const Scratch scratch;
  scratch.write("notes.txt", "mine");
  { REQUIRE(FileTileStore::create(scratch.path(), {}, {})->put({}, Bytes(100))); }
  const auto store = FileTileStore::create(scratch.path(), {}, {});
  CHECK(store->keys().empty());
  CHECK(FileTileStore::open_to_read(scratch.path())->keys().empty());
  CHECK(content_of(scratch.path() / "notes.txt") == "mine");
}

}  // namespace isobar::test::test_file_tile_store

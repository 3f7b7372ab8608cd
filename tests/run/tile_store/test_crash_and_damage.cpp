// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>

#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"

namespace isobar::test::test_crash_and_damage {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

constexpr int kTiles = 6;
constexpr std::size_t kSize = 75;

/// A map of six tiles in one segment, and the content of its two files.
struct SmallMap {
  SmallMap() {
    const auto store = FileTileStore::create(scratch.path(), {}, {});
    for (int n = 0; n < kTiles; ++n) REQUIRE(store->put(key_number(n), tile_bytes(key_number(n), 1, kSize)));
    tiles = content_of(tiles_file());
    index = content_of(index_file());
  }
  [[nodiscard]] std::filesystem::path tiles_file() const { return scratch.path() / "00000000.tiles"; }
  [[nodiscard]] std::filesystem::path index_file() const { return scratch.path() / "00000000.index"; }
  void set(const std::string& tiles_content, const std::string& index_content) const {
    write_content(tiles_file(), tiles_content);
    write_content(index_file(), index_content);
  }

  Scratch scratch;
  std::string tiles;
  std::string index;
};

/// Bitmap of the tiles that can be read. A tile with wrong bytes fails the test.
unsigned whole_tiles(FileTileStore& store) {
  unsigned whole = 0;
  Bytes bytes;
  for (int n = 0; n < kTiles; ++n) {
    if (!store.take(key_number(n), bytes)) continue;
    CHECK(bytes == tile_bytes(key_number(n), 1, kSize));
    whole |= 1U << static_cast<unsigned>(n);
  }
  return whole;
}

constexpr unsigned kAll = (1U << kTiles) - 1;
constexpr unsigned kAllButLast = (1U << (kTiles - 1)) - 1;

/// Opening the map for writing finds `whole` and `torn`, and repairs the map: reopened, it has no faults and
/// still has the tile that was put after the repair.
void check_repaired(const SmallMap& map, unsigned whole, std::uint64_t torn) {
  {
    const auto store = FileTileStore::open_to_continue(map.scratch.path(), {}, {});
    CHECK(store->counters().torn == torn);
    CHECK(whole_tiles(*store) == whole);
    REQUIRE(store->put({99, 0, 0}, Bytes(33)));
  }
  const auto store = FileTileStore::open_to_read(map.scratch.path());
  CHECK(store->counters().torn == 0);
  CHECK(store->counters().damaged == 0);
  CHECK(whole_tiles(*store) == whole);
  CHECK(store->contains({99, 0, 0}));
}

}  // namespace

TEST_CASE("truncated anywhere in its last record, a map has all tiles before it and counts one torn record") {
  const SmallMap map;
  const std::size_t begin = map.tiles.size() / kTiles * (kTiles - 1);
  for (std::size_t end = begin; end <= map.tiles.size(); ++end) {
    CAPTURE(end);
    const bool whole = end == map.tiles.size();
    map.set(map.tiles.substr(0, end), map.index);
    check_repaired(map, whole ? kAll : kAllButLast, whole ? 0 : 1);
    // The process was killed before it wrote the index entry. Without any byte of the record, nothing is
    // torn.
    map.set(map.tiles.substr(0, end), map.index.substr(0, map.index.size() - sizeof(IndexEntry)));
    check_repaired(map, whole ? kAll : kAllButLast, whole || end == begin ? 0 : 1);
    map.set(map.tiles.substr(0, end), "");
    check_repaired(map, whole ? kAll : kAllButLast, whole || end == begin ? 0 : 1);
  }
}

TEST_CASE("an index truncated at any byte loses no tile") {
  const SmallMap map;
  for (std::size_t end = 0; end <= map.index.size(); ++end) {
    CAPTURE(end);
    map.set(map.tiles, map.index.substr(0, end));
    check_repaired(map, kAll, 0);
  }
}

TEST_CASE("a flipped bit anywhere in the tiles is detected and counted, and loses only that tile") {
  const SmallMap map;
  const std::size_t record = map.tiles.size() / kTiles;
  for (std::size_t at = 0; at < map.tiles.size(); ++at) {
    CAPTURE(at);
    std::string flipped = map.tiles;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (at % 8)));
    const bool in_padding = at % record >= sizeof(RecordHead) + kSize;
    const unsigned expected = in_padding ? kAll : kAll & ~(1U << (at / record));
    for (const bool with_index : {true, false}) {
      map.set(flipped, with_index ? map.index : "");
      const auto store = FileTileStore::open_to_read(map.scratch.path());
      CHECK(whole_tiles(*store) == expected);
      CHECK(store->counters().damaged + store->counters().torn == (in_padding ? 0 : 1));
      CHECK(store->counters().first_damage.empty() == in_padding);
    }
  }
}

TEST_CASE("a damaged record just before a torn one is truncated with it and not counted again") {
  const SmallMap map;
  const std::size_t record = map.tiles.size() / kTiles;
  std::string tiles = map.tiles.substr(0, map.tiles.size() - 8);
  tiles[record * (kTiles - 2) + 5] = 'x';
  map.set(tiles, "");
  check_repaired(map, kAllButLast >> 1U, 1);
}

TEST_CASE("a flipped bit anywhere in the index loses no tile") {
  const SmallMap map;
  for (std::size_t at = 0; at < map.index.size(); ++at) {
    CAPTURE(at);
    std::string flipped = map.index;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (at % 8)));
    map.set(map.tiles, flipped);
    check_repaired(map, kAll, 0);
  }
}

TEST_CASE("the message about damage names file, offset, tile and rule") {
  const SmallMap map;
  std::string flipped = map.tiles;
  flipped[sizeof(RecordHead)] = static_cast<char>(flipped[sizeof(RecordHead)] ^ 1);
  map.set(flipped, map.index);
  const auto store = FileTileStore::open_to_read(map.scratch.path());
  Bytes bytes;
  CHECK_FALSE(store->take(key_number(0), bytes));
  CHECK(store->last_damage() ==
        map.tiles_file().string() + ": byte 0: tile (-3, -5, -1): its checksum is wrong");
  CHECK_FALSE(store->contains(key_number(0)));
}

TEST_CASE("a map with random bytes in its files can be opened, and has only tiles that were put") {
  const SmallMap map;
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    std::string tiles = map.tiles;
    std::string index = map.index;
    for (std::string* text : {&tiles, &index}) {
      const std::size_t begin = random() % text->size();
      for (std::size_t i = begin; i < text->size() && i < begin + 200; ++i)
        (*text)[i] = static_cast<char>(random());
    }
    map.set(tiles, index);
    const auto store = FileTileStore::open_to_continue(map.scratch.path(), {}, {});
    whole_tiles(*store);
    CHECK(store->keys().size() <= kTiles);
  }
}

TEST_CASE("a process killed while it writes loses no tile whose put() had returned") {
  const Scratch scratch;
  int written[2] = {-1, -1};  // pipe: numbers of the tiles whose put() returned
  REQUIRE(pipe(written) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    close(written[0]);
    TileStoreLimits limits;
    limits.max_bytes = 64U << 20U;
    const auto store = FileTileStore::create(scratch.path(), {}, limits);
    for (int n = 0;; ++n) {
      const TileKey key{n % 40, 0, 0};
      if (!store->put(key, tile_bytes(key, static_cast<std::uint32_t>(n), 20'000))) _exit(1);
      if (write(written[1], &n, sizeof(n)) != sizeof(n)) _exit(1);
    }
  }
  close(written[1]);
  int last = -1;
  for (int n = 0; n < 500 && read(written[0], &n, sizeof(n)) == sizeof(n);) last = n;
  kill(child, SIGKILL);
  for (int n = 0; read(written[0], &n, sizeof(n)) == sizeof(n);) last = n;
  waitpid(child, nullptr, 0);
  close(written[0]);
  REQUIRE(last >= 499);
  const auto store = FileTileStore::open_to_continue(scratch.path(), {}, {});
  CHECK(store->counters().damaged == 0);
  Bytes bytes;
  for (int n = last - 39; n <= last; ++n) {
    const TileKey key{n % 40, 0, 0};
    REQUIRE(store->take(key, bytes));
    // One more tile may have been written completely before the process could report it.
    const auto version = static_cast<std::uint32_t>(n);
    const bool as_reported = bytes == tile_bytes(key, version, 20'000);
    CHECK((as_reported || (n == last - 39 && bytes == tile_bytes(key, version + 40, 20'000))));
  }
}

}  // namespace isobar::test::test_crash_and_damage

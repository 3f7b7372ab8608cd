// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>
#include <map>
#include <random>

#include "tests/run/recording/scratch.hpp"
#include "tests/run/tile_store/tiles.hpp"

namespace isobar::test::test_compaction_and_limit {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

std::uint64_t bytes_in(const std::filesystem::path& folder) {
  std::uint64_t sum = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".tiles" || extension == ".index") sum += entry.file_size();
  }
  return sum;
}

/// Limits the size of files that this process writes, during its lifetime.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : former_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit limit{bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, former_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit former_{};
  void (*former_handler_)(int);
};

}  // namespace

TEST_CASE(
    "compaction keeps the newest version of every tile and the disk space below about twice their size") {
  const Scratch scratch;
  TileStoreLimits limits;
  limits.max_bytes = 16U << 20U;  // segments of 256 KiB
  const auto store = FileTileStore::create(scratch.path(), {}, limits);
  std::mt19937 random(11);
  std::map<TileKey, Bytes> expected;
  // 400 tiles of 4 kB; 90 % of the puts go to 20 of them, as for a robot that goes to and fro.
  for (std::uint32_t version = 0; version < 12'000; ++version) {
    const int n = static_cast<int>(random() % 10 == 0 ? random() % 400 : random() % 20);
    const TileKey key{n, 0, 0};
    Bytes bytes = tile_bytes(key, version, 3'000 + random() % 2'000);
    REQUIRE(store->put(key, bytes));
    expected[key] = std::move(bytes);
  }
  CHECK(store->counters().moved > 100);
  CHECK(store->counters().forgotten == 0);
  CHECK(store->counters().damaged == 0);
  CHECK(store->disk_bytes() == bytes_in(scratch.path()));
  // Half of a closed segment may be superseded; the newest one and the one being compacted come on top.
  CHECK(store->disk_bytes() < 2 * store->live_bytes() + 3 * limits.segment_bytes());
  Bytes bytes;
  const auto again = FileTileStore::open_to_read(scratch.path());
  CHECK(again->live_bytes() == store->live_bytes());
  for (const auto& [key, content] : expected) {
    REQUIRE(store->take(key, bytes));
    CHECK(bytes == content);
    REQUIRE(again->take(key, bytes));
    CHECK(bytes == content);
  }
}

TEST_CASE("compaction of a segment with a damaged tile loses only that tile") {
  const Scratch scratch;
  TileStoreLimits limits;
  limits.max_bytes = 16U << 20U;
  const auto store = FileTileStore::create(scratch.path(), {}, limits);
  // The first segment is closed with 64 tiles of 4000 bytes; then the tiles from number 20 on are superseded.
  for (int n = 0; n < 66; ++n) REQUIRE(store->put({n, 0, 0}, tile_bytes({n, 0, 0}, 1, 4'000)));
  std::string content = content_of(scratch.path() / "00000000.tiles");
  content[record_bytes(4'000) * 3 + 100] = static_cast<char>(content[record_bytes(4'000) * 3 + 100] ^ 16);
  write_content(scratch.path() / "00000000.tiles", content);
  for (int n = 20; n < 66; ++n) REQUIRE(store->put({n, 0, 0}, tile_bytes({n, 0, 0}, 2, 4'000)));
  CHECK_FALSE(std::filesystem::exists(scratch.path() / "00000000.tiles"));
  CHECK(store->counters().damaged == 1);
  CHECK(store->tile_count() == 65);
  Bytes bytes;
  CHECK_FALSE(store->contains({3, 0, 0}));
  for (int n = 0; n < 66; ++n) {
    if (n == 3) continue;
    REQUIRE(store->take({n, 0, 0}, bytes));
    CHECK(bytes == tile_bytes({n, 0, 0}, n < 20 ? 1 : 2, 4'000));
  }
}

TEST_CASE("at the limit the oldest tiles are removed and counted, and the disk space never exceeds it") {
  const Scratch scratch;
  TileStoreLimits limits;
  limits.max_bytes = 2U << 20U;
  const auto store = FileTileStore::create(scratch.path(), {}, limits);
  constexpr int kPut = 2'000;
  for (int n = 0; n < kPut; ++n) {
    REQUIRE(store->put({n, 0, 0}, tile_bytes({n, 0, 0}, 1, 5'000)));
    REQUIRE(bytes_in(scratch.path()) <= limits.max_bytes);
  }
  CHECK(store->counters().refused == 0);
  CHECK(store->tile_count() + store->counters().forgotten == kPut);
  // At most one segment less than the limit is used.
  CHECK(store->disk_bytes() > limits.max_bytes - limits.segment_bytes() - 6'000);
  const int oldest = kPut - static_cast<int>(store->tile_count());
  for (int n = 0; n < kPut; ++n) CHECK(store->contains({n, 0, 0}) == (n >= oldest));
}

TEST_CASE("near the limit superseded versions are removed before any live tile") {
  const Scratch scratch;
  TileStoreLimits limits;
  limits.max_bytes = 2U << 20U;
  const auto store = FileTileStore::create(scratch.path(), {}, limits);
  std::mt19937 random(5);
  // 1.1 MB of live tiles within 2 MB, put over and over.
  for (std::uint32_t version = 0; version < 6'000; ++version) {
    const TileKey key{static_cast<int>(random() % 220), 0, 0};
    REQUIRE(store->put(key, tile_bytes(key, version, 5'000)));
  }
  CHECK(store->tile_count() == 220);
  CHECK(store->counters().forgotten == 0);
}

TEST_CASE("a failed write loses only the new tile, is counted with its reason, and is not permanent") {
  const Scratch scratch;
  const auto store = FileTileStore::create(scratch.path(), {}, {});
  for (int n = 0; n < 10; ++n) REQUIRE(store->put({n, 0, 0}, tile_bytes({n, 0, 0}, 1, 5'000)));
  {
    const FileSizeLimit full(53'000);  // the eleventh tile can be written only in part
    CHECK_FALSE(store->put({10, 0, 0}, tile_bytes({10, 0, 0}, 1, 5'000)));
    CHECK_FALSE(store->put({3, 0, 0}, tile_bytes({3, 0, 0}, 2, 5'000)));
    CHECK(store->counters().refused == 2);
    CHECK(store->counters().first_refusal.find("00000000.tiles: ") != std::string::npos);
    Bytes bytes;
    REQUIRE(store->take({3, 0, 0}, bytes));
    CHECK(bytes == tile_bytes({3, 0, 0}, 1, 5'000));
  }
  REQUIRE(store->put({10, 0, 0}, tile_bytes({10, 0, 0}, 1, 5'000)));
  const auto again = FileTileStore::open_to_read(scratch.path());
  CHECK(again->counters().torn == 0);
  CHECK(again->counters().damaged == 0);
  CHECK(again->tile_count() == 11);
}

TEST_CASE("an index that could not be written is rebuilt by the next opening") {
  const Scratch scratch;
  {
    const auto store = FileTileStore::create(scratch.path(), {}, {});
    REQUIRE(store->put({0, 0, 0}, tile_bytes({0, 0, 0}, 1, 10)));
    std::filesystem::remove(scratch.path() / "00000000.index");  // the next entry goes to an unlinked file
    REQUIRE(store->put({1, 0, 0}, tile_bytes({1, 0, 0}, 1, 10)));
  }
  CHECK(FileTileStore::open_to_continue(scratch.path(), {}, {})->tile_count() == 2);
  CHECK(content_of(scratch.path() / "00000000.index").size() == 2 * sizeof(IndexEntry));
}

}  // namespace isobar::test::test_compaction_and_limit

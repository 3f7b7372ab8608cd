// SPDX-License-Identifier: BSD-3-Clause
// Cost of a large map on disk: writing it tile by tile, opening it, reading tiles.
// Usage: bench_tile_store FOLDER [GB] [TILE_KB]; a map of that size is written to the folder (default 1 GB,
// tiles of 45 kB on average, more than ten million points at 45 bytes) and removed again.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "run/tile_store/file_tile_store.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a program
using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Durations of one kind of call.
struct Times {
  std::vector<double> ms;
  void print(const char* what) {
    std::sort(ms.begin(), ms.end());
    const auto at = [&](double share) {
      return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
    };
    std::printf("%-28s %8zu calls  p50 %8.3f ms  p99 %8.3f ms  max %8.3f ms\n", what, ms.size(), at(0.5),
                at(0.99), ms.back());
  }
};

/// Drops the pages of the map's files from the page cache: the next opening reads from the disk.
void drop_cache(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const FileDescriptor file(::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) continue;
    static_cast<void>(::fdatasync(file.get()));
    static_cast<void>(::posix_fadvise(file.get(), 0, 0, POSIX_FADV_DONTNEED));
  }
}

void time_opening(const std::filesystem::path& folder, const char* what) {
  const auto begin = Clock::now();
  const auto store = FileTileStore::open_to_read(folder);
  std::printf("%-28s %8.1f ms for %zu tiles, %.2f GB\n", what, ms_since(begin), store->tile_count(),
              static_cast<double>(store->disk_bytes()) * 1e-9);
}

/// Keys and random contents of the tiles of a map.
class Tiles {
 public:
  Tiles(double gigabytes, double tile_kb)
      : tile_kb_(tile_kb),
        count_(static_cast<int>(gigabytes * 1e6 / tile_kb)),
        bytes_(static_cast<std::size_t>(tile_kb * 1.8e3)) {
    for (std::byte& byte : bytes_) byte = static_cast<std::byte>(random_());
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] static TileKey key(int n) { return {n / 36, n / 3 % 12, n % 3}; }
  TileKey random_key() { return key(static_cast<int>(random_() % static_cast<unsigned>(count_))); }
  /// Contents of a random size: one fifth to nine fifths of the mean.
  std::span<const std::byte> contents() {
    return std::span(bytes_).first(
        static_cast<std::size_t>(tile_kb_ * 1e3 * (0.2 + 1.6 * random_() / 4294967296.0)));
  }

 private:
  double tile_kb_;
  int count_;
  std::mt19937 random_{1};
  std::vector<std::byte> bytes_;
};

double put_ms(FileTileStore& store, const TileKey& key, std::span<const std::byte> bytes) {
  const auto begin = Clock::now();
  if (!store.put(key, bytes)) throw std::runtime_error(store.counters().first_refusal);
  return ms_since(begin);
}

void time_writing(const std::filesystem::path& folder, double gigabytes, Tiles& tiles) {
  TileStoreLimits limits;
  limits.max_bytes = static_cast<std::uint64_t>(gigabytes * 2e9);
  Times first_tenth;
  Times last_tenth;
  Times again;
  const int count = tiles.count();
  {
    const auto store = FileTileStore::create(folder, {}, limits);
    for (int n = 0; n < count; ++n) {
      const double ms = put_ms(*store, Tiles::key(n), tiles.contents());
      if (n < count / 10) first_tenth.ms.push_back(ms);
      if (n >= count - count / 10) last_tenth.ms.push_back(ms);
    }
    // The robot moves back and forth at the end: new versions of tiles, compaction of files.
    for (int n = 0; n < count / 2; ++n) {
      again.ms.push_back(put_ms(*store, Tiles::key(count - 1 - n % (count / 10)), tiles.contents()));
    }
  }
  first_tenth.print("put, first tenth");
  last_tenth.print("put, last tenth");
  again.print("put again, with compaction");
}

void time_taking(const std::filesystem::path& folder, Tiles& tiles) {
  Times taken;
  std::vector<std::byte> out;
  const auto store = FileTileStore::open_to_read(folder);
  for (int n = 0; n < 5'000; ++n) {
    const TileKey key = tiles.random_key();
    const auto begin = Clock::now();
    if (!store->take(key, out)) throw std::runtime_error(store->last_damage());
    taken.ms.push_back(ms_since(begin));
  }
  taken.print("take, first from the disk");
}

void run(const std::filesystem::path& folder, double gigabytes, double tile_kb) {
  Tiles tiles(gigabytes, tile_kb);
  time_writing(folder, gigabytes, tiles);
  time_opening(folder, "open, in the page cache");
  drop_cache(folder);
  time_opening(folder, "open, from the disk");
  time_taking(folder, tiles);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".index") std::filesystem::remove(entry.path());
  }
  drop_cache(folder);
  time_opening(folder, "open, disk, no index");
  remove_map(folder);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 4) {
    std::fprintf(stderr, "usage: bench_tile_store FOLDER [GB] [TILE_KB]\n");
    return 64;
  }
  try {
    run(arguments[1], count > 2 ? std::atof(arguments[2]) : 1.0, count > 3 ? std::atof(arguments[3]) : 45.0);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_tile_store: %s\n", error.what());
    return 69;
  }
}

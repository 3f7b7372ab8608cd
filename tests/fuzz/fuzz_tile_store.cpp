// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a stored map: tiles, index and map.toml, separated by the lengths of the first two.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace {

std::filesystem::path make_folder() {
  std::string name = "/dev/shm/isobar-fuzz-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) std::abort();
  std::atexit([] { std::filesystem::remove_all("/dev/shm/isobar-fuzz-" + std::to_string(getpid())); });
  const std::filesystem::path folder = "/dev/shm/isobar-fuzz-" + std::to_string(getpid());
  std::filesystem::remove_all(folder);
  std::filesystem::rename(name, folder);
  return folder;
}

void write(const std::filesystem::path& file, std::string_view content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

/// Every listed tile can be read or is counted as damaged.
void take_all(isobar::FileTileStore& store) {
  std::vector<std::byte> bytes;
  const std::uint64_t before = store.counters().damaged;
  std::uint64_t bad = 0;
  for (const isobar::TileKey& key : store.keys()) bad += store.take(key, bytes) ? 0 : 1;
  if (store.counters().damaged - before != bad) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = make_folder();
  std::uint16_t lengths[2];  // NOLINT: filled below
  if (size < sizeof(lengths)) return 0;
  std::memcpy(lengths, data, sizeof(lengths));
  const std::string_view text(reinterpret_cast<const char*>(data) + sizeof(lengths), size - sizeof(lengths));
  const std::string_view tiles = text.substr(0, lengths[0]);
  const std::string_view index = text.substr(tiles.size()).substr(0, lengths[1]);
  const std::string_view header = text.substr(tiles.size() + index.size());
  isobar::remove_map(folder);
  write(folder / "00000000.tiles", tiles);
  write(folder / "00000000.index", index);
  write(folder / "map.toml", header.empty() ? "format = 1\ntile_m = 8.0\ncell_m = 0.25\n" : header);
  try {
    take_all(*isobar::FileTileStore::open_to_read(folder));
    std::size_t repaired = 0;
    {
      const auto store = isobar::FileTileStore::open_to_continue(folder, {}, {});
      repaired = store->tile_count();
    }
    // Idempotence: a second repair changes nothing and loses no tile.
    const auto store = isobar::FileTileStore::open_to_continue(folder, {}, {});
    if (store->counters().torn != 0 || store->tile_count() != repaired) std::abort();
    if (!store->put({1, 2, 3}, std::vector<std::byte>(20))) std::abort();
    take_all(*store);
    if (!store->contains({1, 2, 3})) std::abort();
  } catch (const isobar::DataError&) {
    return 0;  // not a map
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// `isobar map`: what is in the map of a run, whether it is whole, and its points as a file.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/map/map_tile.hpp"
#include "run/files/map_export.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tools/commands.hpp"

namespace isobar::tools {

namespace {

using Store = std::unique_ptr<FileTileStore>;
using Count = unsigned long long;

/// The map of a folder, or the one in the folder of a run.
Store open_map(const std::filesystem::path& directory) {
  const std::filesystem::path inside = directory / "map";
  const bool is_run =
      !std::filesystem::exists(directory / "map.toml") && std::filesystem::exists(inside / "map.toml");
  return FileTileStore::open_to_read(is_run ? inside : directory);
}

/// What the opening found to be wrong, in words; nothing where all is well.
void print_faults(const TileStoreCounters& counters) {
  if (counters.torn > 0) {
    std::printf("torn: %llu tiles whose writing was cut off, or is going on\n", Count{counters.torn});
  }
  if (counters.damaged > 0) std::printf("damaged: %llu\n", Count{counters.damaged});
  if (!counters.first_damage.empty()) std::printf("first: %s\n", counters.first_damage.c_str());
}

files::MapBox extent_of(const std::vector<TileKey>& keys, double tile_m) {
  files::MapBox extent = files::MapBox::of_tile(keys.front(), tile_m);
  for (const TileKey& key : keys) {
    const files::MapBox box = files::MapBox::of_tile(key, tile_m);
    extent.lowest = extent.lowest.cwiseMin(box.lowest);
    extent.highest = extent.highest.cwiseMax(box.highest);
  }
  return extent;
}

void run_info(const std::filesystem::path& directory) {
  const auto begin = std::chrono::steady_clock::now();
  const Store store = open_map(directory);
  const std::chrono::duration<double, std::milli> opened = std::chrono::steady_clock::now() - begin;
  const std::vector<TileKey> keys = store->keys();
  std::printf("tiles: %zu of %g m, cells of %g m\n", keys.size(), store->header().tile_m,
              store->header().cell_m);
  std::printf("bytes: %llu of tiles, %llu on the disk in %zu files\n", Count{store->live_bytes()},
              Count{store->disk_bytes()}, store->segment_count());
  if (!keys.empty()) {
    const files::MapBox extent = extent_of(keys, store->header().tile_m);
    std::printf("extent: x %g … %g, y %g … %g, z %g … %g m\n", extent.lowest.x(), extent.highest.x(),
                extent.lowest.y(), extent.highest.y(), extent.lowest.z(), extent.highest.z());
  }
  std::printf("opened in %.1f ms\n", opened.count());
  print_faults(store->counters());
}

void run_check(const std::filesystem::path& directory) {
  const Store store = open_map(directory);
  print_faults(store->counters());
  std::uint64_t bad = store->counters().damaged + store->counters().torn;
  std::vector<std::byte> bytes;
  std::vector<MapPoint> points;
  const std::vector<TileKey> keys = store->keys();
  std::uint64_t point_count = 0;
  for (const TileKey& key : keys) {
    points.clear();
    if (!store->take(key, bytes)) {
      std::printf("%s\n", store->last_damage().c_str());
      ++bad;
    } else if (!append_tile_points(bytes, points)) {
      std::printf("%s: %s: its bytes are not a tile of this program\n", directory.c_str(),
                  files::tile_name(key).c_str());
      ++bad;
    }
    point_count += points.size();
  }
  if (bad > 0) {
    throw DataError(directory.string() + ": " + std::to_string(bad) + " tiles or stretches are damaged, " +
                    std::to_string(store->tile_count()) + " tiles can be read");
  }
  std::printf("%s: all right: %zu tiles, %llu points\n", directory.c_str(), keys.size(), Count{point_count});
}

void run_export(const std::filesystem::path& directory, const std::filesystem::path& out,
                const std::vector<double>& corners) {
  std::optional<files::MapBox> box;
  if (!corners.empty()) {
    box = files::MapBox{{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}};
    if (!(box->lowest.array() <= box->highest.array()).all()) {
      throw UsageError("--box: each of the first three numbers must not be above the one three behind it");
    }
  }
  const Store store = open_map(directory);
  files::PlyWriter ply(out);
  const files::MapExport done = files::export_map(*store, store->header(), box, ply);
  ply.close();
  print_faults(store->counters());
  std::printf("%llu points of %llu tiles in %s\n", Count{done.points}, Count{done.tiles}, out.c_str());
  if (done.unreadable > 0) {
    throw DataError(directory.string() + ": " + std::to_string(done.unreadable) +
                    " tiles could not be read and are left out; the first: " + done.first_unreadable);
  }
}

}  // namespace

void add_map_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("map", "Look at the map of a run, check it, export its points");
  command->require_subcommand(1);
  const auto directory = std::make_shared<std::filesystem::path>();
  const auto takes_map = [&](const char* name, const char* what) {
    CLI::App* part = command->add_subcommand(name, what);
    part->add_option("DIR", *directory, "folder of a map, or of a run with the map in it")->required();
    return part;
  };
  takes_map("info", "Tiles, bytes, extent, faults")->callback([directory] { run_info(*directory); });
  takes_map("check", "Read everything; exit code 65 names what is damaged")->callback([directory] {
    run_check(*directory);
  });
  CLI::App* to_file = takes_map("export", "Write the points as PLY, sorted by tile");
  const auto out = std::make_shared<std::filesystem::path>();
  const auto box = std::make_shared<std::vector<double>>();
  to_file->add_option("--out", *out, "PLY file: x y z intensity")->required();
  to_file->add_option("--box", *box, "only what is within X0 Y0 Z0 X1 Y1 Z1 [m]")->expected(6);
  to_file->callback([directory, out, box] { run_export(*directory, *out, *box); });
}

}  // namespace isobar::tools

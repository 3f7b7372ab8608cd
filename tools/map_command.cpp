// SPDX-License-Identifier: BSD-3-Clause
// `isobar map`: contents, check and export of the map of a run; floors and grids are in files of their own.
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
#include "run/building/building_store.hpp"
#include "run/files/map_export.hpp"
#include "run/files/run_layout.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tools/commands.hpp"
#include "tools/map_parts.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

std::filesystem::path map_folder_of(const std::filesystem::path& directory) {
  const std::filesystem::path inside = directory / files::kMapDirectory;
  const bool is_run =
      !std::filesystem::exists(directory / "map.toml") && std::filesystem::exists(inside / "map.toml");
  return is_run ? inside : directory;
}

std::unique_ptr<FileTileStore> open_map(const std::filesystem::path& directory) {
  return FileTileStore::open_to_read(map_folder_of(directory));
}

void print_faults(const TileStoreCounters& counters) {
  if (counters.torn > 0) {
    std::printf("torn: %llu tiles with an interrupted or unfinished write\n",
                static_cast<unsigned long long>(counters.torn));
  }
  if (counters.damaged > 0) {
    std::printf("damaged: %llu\n", static_cast<unsigned long long>(counters.damaged));
  }
  if (!counters.first_damage.empty()) std::printf("first: %s\n", counters.first_damage.c_str());
}

namespace {

using Store = std::unique_ptr<FileTileStore>;
using Count = unsigned long long;

files::MapBox extent_of(const std::vector<TileKey>& keys, double tile_m) {
  files::MapBox extent = files::MapBox::of_tile(keys.front(), tile_m);
  for (const TileKey& key : keys) {
    const files::MapBox box = files::MapBox::of_tile(key, tile_m);
    extent.lowest = extent.lowest.cwiseMin(box.lowest);
    extent.highest = extent.highest.cwiseMax(box.highest);
  }
  return extent;
}

/// Submaps, key scans and loops, where the map has them.
void print_building(const std::filesystem::path& directory) {
  const auto store = BuildingStore::open_to_read(map_folder_of(directory));
  if (!store) return;
  const StoredBuilding& building = store->stored();
  std::size_t keys = 0;
  for (const Submap& submap : building.submaps) keys += submap.keys.size();
  std::printf("building: %zu submaps, %zu key scans, %zu loops; the map was laid anew %zu times\n",
              building.submaps.size(), keys, building.loops.size(), building.moved_ns.size());
  if (store->counters().removed_bytes > 0) {
    std::printf("building: the last %llu bytes of its log are unfinished or damaged\n",
                Count{store->counters().removed_bytes});
  }
}

struct MapOptions {
  std::filesystem::path directory;
  std::filesystem::path out;
  std::vector<double> box;
};

void run_info(const MapOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Store store = open_map(options.directory);
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
  print_building(options.directory);
  std::printf("opened in %.1f ms\n", opened.count());
  print_faults(store->counters());
}

struct TileCheck {
  std::uint64_t unreadable = 0;  ///< damaged tiles, and tiles that this program cannot decode
  std::uint64_t points = 0;
};

/// Reads every tile and prints the unreadable ones.
TileCheck check_tiles(FileTileStore& store, const std::filesystem::path& directory) {
  TileCheck result;
  std::vector<std::byte> bytes;
  std::vector<MapPoint> points;
  for (const TileKey& key : store.keys()) {
    points.clear();
    if (!store.take(key, bytes)) {
      std::printf("%s\n", store.last_damage().c_str());
      ++result.unreadable;
    } else if (!MapTile::append_stored_points(bytes, points)) {
      std::printf("%s: %s: cannot be decoded as a tile\n", directory.c_str(), files::tile_name(key).c_str());
      ++result.unreadable;
    }
    result.points += points.size();
  }
  return result;
}

void run_check(const MapOptions& options) {
  const Store store = open_map(options.directory);
  print_faults(store->counters());
  const TileCheck tiles = check_tiles(*store, options.directory);
  const std::uint64_t bad = store->counters().damaged + store->counters().torn + tiles.unreadable;
  if (bad > 0) {
    throw DataError(options.directory.string() + ": " + std::to_string(bad) +
                    " tiles or records are damaged, " + std::to_string(store->tile_count()) +
                    " tiles are readable");
  }
  std::printf("%s: no damage: %zu tiles, %llu points\n", options.directory.c_str(), store->tile_count(),
              Count{tiles.points});
}

/// @throws UsageError when a lower corner is above the upper one
std::optional<files::MapBox> box_of(const std::vector<double>& corners) {
  if (corners.empty()) return std::nullopt;
  const files::MapBox box{{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}};
  if (!(box.lowest.array() <= box.highest.array()).all()) {
    throw UsageError("--box: must be X0 <= X1, Y0 <= Y1, Z0 <= Z1");
  }
  return box;
}

void run_export(const MapOptions& options) {
  const std::optional<files::MapBox> box = box_of(options.box);
  const Store store = open_map(options.directory);
  if (store->tile_count() == 0) {
    throw DataError(options.directory.string() + ": the map holds no tiles yet, so nothing was exported");
  }
  const auto file = files::open_point_file(options.out);
  const files::MapExport done = files::export_map(*store, store->header(), box, *file);
  file->close();
  print_faults(store->counters());
  std::printf("%llu points of %llu tiles in %s\n", Count{done.points}, Count{done.tiles},
              options.out.c_str());
  if (done.points == 0) {
    const files::MapBox extent = extent_of(store->keys(), store->header().tile_m);
    std::printf("no points in the box: the map extends over x %g … %g, y %g … %g, z %g … %g m\n",
                extent.lowest.x(), extent.highest.x(), extent.lowest.y(), extent.highest.y(),
                extent.lowest.z(), extent.highest.z());
  }
  if (done.unreadable > 0) {
    throw DataError(options.directory.string() + ": " + std::to_string(done.unreadable) +
                    " tiles are unreadable and left out; the first: " + done.first_unreadable);
  }
}

/// Adds "map NAME DIR".
template <typename Run>
Subcommand<MapOptions> add_part(CLI::App& map, const char* name, const char* purpose, Run run) {
  const auto part = add_subcommand<MapOptions>(map, name, purpose, run);
  part.command.add_option("DIR", part.options.directory, "folder of a map, or of a run")->required();
  return part;
}

}  // namespace

void add_map_command(CLI::App& app) {
  CLI::App& map =
      *app.add_subcommand("map", "Show, check, export and merge the maps of runs; their floors and grids");
  map.require_subcommand(1);
  add_part(map, "info", "Tiles, bytes, extent, damage", run_info);
  add_part(map, "check", "Read every tile; exit code 65 when any is damaged", run_check);
  const auto [command, options] =
      add_part(map, "export", "Write the points for other programs, in the order of the tiles", run_export);
  command
      .add_option("--out", options.out,
                  "file of points, in the format of its ending: " + std::string(files::kPointFileEndings))
      ->required();
  command.add_option("--box", options.box, "only points in the box X0 Y0 Z0 X1 Y1 Z1 [m]")->expected(6);
  add_map_floors_command(map);
  add_map_grid_command(map);
  add_map_merge_command(map);
}

}  // namespace isobar::tools

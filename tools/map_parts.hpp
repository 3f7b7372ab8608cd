// SPDX-License-Identifier: BSD-3-Clause
// What the subcommands of `isobar map` share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "run/tile_store/file_tile_store.hpp"

namespace isobar::tools {

/// The folder of a map: the one that is named, or the one in the folder of a run.
std::filesystem::path map_folder_of(const std::filesystem::path& directory);
/// Opens a map's folder, or the map in the folder of a run, to read; it may be being written.
std::unique_ptr<FileTileStore> open_map(const std::filesystem::path& directory);
/// Prints the damage found on opening; nothing without damage.
void print_faults(const TileStoreCounters& counters);

/// Height of base_link on a floor of a map [m], by the floor's number or name.
/// @throws UsageError naming the floors that there are, for an unknown one
[[nodiscard]] double base_height_on(const std::filesystem::path& directory, const std::string& floor);

/// Add "map floors", "map grid" and "map merge".
void add_map_floors_command(CLI::App& map);
void add_map_grid_command(CLI::App& map);
void add_map_merge_command(CLI::App& map);

}  // namespace isobar::tools

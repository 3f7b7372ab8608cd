// SPDX-License-Identifier: BSD-3-Clause
// The exchange of a map's folder for one that was laid anew, in steps that a crash may interrupt:
//
//   MAP.next/          the tiles are being written; of no use after a crash
//   MAP.next/complete  they are whole: from here on the exchange is carried out, whenever it is interrupted
//   MAP.old/           the former map, without its building, until it has been removed
#pragma once

#include <filesystem>
#include <memory>

#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Creates the empty store of the next map beside `map_folder`, instead of an unfinished one.
/// @throws ServiceError when the disk refuses
[[nodiscard]] std::unique_ptr<FileTileStore> create_next_map(const std::filesystem::path& map_folder,
                                                             const MapHeader& header,
                                                             const TileStoreLimits& limits);
/// Removes a next map, complete or not: the map is going to be another one.
void remove_next_map(const std::filesystem::path& map_folder);
/// All tiles are written, and the store is closed: the next map may take the place of the map.
/// @throws ServiceError when the disk refuses
void complete_next_map(const std::filesystem::path& map_folder);

/// Puts a complete next map in the place of the map, whose building and other files (floors.toml, datum) it takes over;
/// removes an unfinished one. Does nothing where there is none. No store of the map is open.
/// @return true where the map was exchanged
/// @throws ServiceError when the disk refuses: the exchange goes on with the next call
bool settle_next_map(const std::filesystem::path& map_folder);

}  // namespace isobar

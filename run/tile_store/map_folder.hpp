// SPDX-License-Identifier: BSD-3-Clause
// The folder of a map: map.toml says what it is, `lock` who writes it, the rest are tiles (tile_record.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar {

/// map.toml.
struct MapHeader {
  static constexpr std::int64_t kFormat = 1;
  double tile_m = 8.0;   ///< edge of a tile [m], above 0, up to 1000
  double cell_m = 0.25;  ///< edge of a cell [m], above 0, up to tile_m
  bool operator==(const MapHeader&) const = default;
};

/// Reads DIR/map.toml. Throws DataError "file:line:column: key: rule", also where there is none: no map.
MapHeader read_map_header(const std::filesystem::path& directory);
/// Writes it. Throws ServiceError.
void write_map_header(const std::filesystem::path& directory, const MapHeader& header);

/// Held by the one process that may write in the folder; the kernel gives it back when that process ends.
class MapLock {
 public:
  /// Makes the folder if it is missing. Throws ServiceError naming who holds the lock.
  explicit MapLock(const std::filesystem::path& directory);

 private:
  FileDescriptor file_;
};

/// Numbers of the files of tiles in the folder, ascending.
std::vector<std::uint32_t> segment_numbers(const std::filesystem::path& directory);
/// DIR/NNNNNNNN.tiles
std::filesystem::path segment_file(const std::filesystem::path& directory, std::uint32_t number);
/// Removes the map from the folder and leaves alone what is no part of one. Hold the lock.
void remove_map(const std::filesystem::path& directory);

}  // namespace isobar

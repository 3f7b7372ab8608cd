// SPDX-License-Identifier: BSD-3-Clause
// Folder of a map: `map.toml` (format and grid), `lock` (held by the process that writes), segments of tiles
// with their indices (tile_record.hpp), the journal of the newest scans (scan_journal.hpp), and `checkpoint`, the height datum
// of the map and the last place in it (run/files/checkpoint.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar {

/// Content of map.toml.
struct MapHeader {
  static constexpr std::int64_t kFormat = 1;  ///< version of the format
  double tile_m = 8.0;                        ///< edge of a tile [m], above 0, up to 1000
  double cell_m = 0.25;                       ///< edge of a cell [m], above 0, up to tile_m
  bool operator==(const MapHeader&) const = default;
};

/// Reads DIR/map.toml.
/// @throws DataError when the file is missing or breaks a rule; the text is "file:line:column: key: rule"
MapHeader read_map_header(const std::filesystem::path& directory);
/// Writes DIR/map.toml, as a whole whenever the machine ends.
/// @throws ServiceError when the file cannot be written
void write_map_header(const std::filesystem::path& directory, const MapHeader& header);

/// Lock of the one process that writes the map. The kernel releases it when the process ends.
class MapLock {
 public:
  /// Creates the folder if it is missing, and takes the lock.
  /// @throws ServiceError when another process holds the lock (the text names it) or a file cannot be opened
  explicit MapLock(const std::filesystem::path& directory);
  /// True while the lock's file is in its folder: nobody has deleted or replaced it.
  [[nodiscard]] bool in_place() const;

 private:
  std::filesystem::path path_;
  FileDescriptor file_;
};

/// Waits until the names of new files are on the disk, where the file system can.
void sync_folder(const std::filesystem::path& directory) noexcept;

inline constexpr const char* kTilesExtension = ".tiles";  ///< segments of tiles (tile_segment.hpp)
inline constexpr const char* kScansExtension = ".scans";  ///< parts of the journal (scan_journal.hpp)

/// Folder in that of a map: its building (run/building).
inline constexpr const char* kBuildingFolder = "building";

/// Numbers of the files NNNNNNNN.EXTENSION in the folder, ascending.
/// @throws ServiceError when the folder cannot be read
std::vector<std::uint32_t> file_numbers(const std::filesystem::path& directory, const char* extension);
/// Path of such a file.
std::filesystem::path numbered_file(const std::filesystem::path& directory, std::uint32_t number,
                                    const char* extension);
/// True for a file in the folder of a map that belongs to its tiles: header, lock, segments, indices, journal.
[[nodiscard]] bool is_of_tiles(const std::filesystem::path& file);
/// Deletes the files of the map and no other file of the folder. The caller holds the lock.
/// @throws ServiceError when a file cannot be deleted
void remove_map(const std::filesystem::path& directory);

}  // namespace isobar

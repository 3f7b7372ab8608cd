// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "config/config.hpp"
#include "run/tile_store/disk_flusher.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Stores of the map frames of a live run: one folder a frame, never emptied. One thread at a time: the main
/// thread until the map thread starts and after it has stopped.
class MapStores {
 public:
  explicit MapStores(const Config& config);

  /// True if a folder for maps is configured.
  [[nodiscard]] bool configured() const { return !first_.empty(); }
  /// Folder of the first map frame.
  [[nodiscard]] const std::filesystem::path& folder() const { return first_; }
  /// Number of the newest map frame that has a folder; 0: none.
  [[nodiscard]] std::uint32_t newest_session() const;

  /// Opens the store of a map frame, or creates it where its folder holds no map.
  /// @return nullptr when no folder is configured
  /// @throws DataError for a map with another grid; ServiceError when the disk refuses
  FileTileStore* open(std::uint32_t session);
  /// Opens the present store anew, in a new folder, after its folder was deleted, with the tiles that can
  /// still be read.
  /// @throws ServiceError when the disk refuses
  FileTileStore* open_again();
  /// True if the disk of the maps has no room or is read-only.
  [[nodiscard]] bool disk_is_full() const;
  /// True while the folder of the present store is in its place.
  [[nodiscard]] bool in_place() const;
  [[nodiscard]] FileTileStore* current() { return store_.get(); }

  /// Tiles written by the map thread, waited for by another one.
  [[nodiscard]] DiskFlusher& flusher() { return flusher_; }

 private:
  [[nodiscard]] std::filesystem::path folder_of(std::uint32_t session) const;

  std::filesystem::path first_;
  bool beside_ = true;  ///< folders of later frames are beside the first one, not inside
  MapHeader header_;
  TileStoreLimits limits_;
  std::uint32_t session_ = 1;
  std::unique_ptr<FileTileStore> store_;
  DiskFlusher flusher_;
};

}  // namespace isobar

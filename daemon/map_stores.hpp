// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "config/config.hpp"
#include "daemon/stored_map.hpp"
#include "run/tile_store/disk_flusher.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "run/tile_store/scan_journal.hpp"

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
  /// Folder of a map frame; empty when none is configured. Any thread.
  [[nodiscard]] std::filesystem::path folder_of(std::uint32_t session) const;
  /// Number of the newest map frame that has a folder; 0: none.
  [[nodiscard]] std::uint32_t newest_session() const;

  /// Opens the store of a map frame, or creates it where its folder holds no map.
  /// @return nullptr when no folder is configured
  /// @throws DataError for a map with another grid; ServiceError when the disk refuses
  FileTileStore* open(std::uint32_t session);
  /// Opens a map that is only read, whatever folder is configured for maps.
  /// @throws DataError for a map with another grid; ServiceError when the disk refuses
  void open_read_only(const std::filesystem::path& folder);
  [[nodiscard]] bool read_only() const { return read_only_.has_value(); }
  /// Storage for the tiles of the present map; null: none.
  [[nodiscard]] TileStorage* storage() {
    if (read_only_) return &*read_only_;
    return store_.get();
  }
  [[nodiscard]] const MapHeader& header() const { return header_; }
  /// Opens the present store anew, in a new folder, after its folder was deleted, with the tiles that can
  /// still be read.
  /// @throws ServiceError when the disk refuses
  FileTileStore* open_again();
  /// Closes the present store, puts the map that was laid anew in its place, and opens that.
  /// @throws DataError, ServiceError as open(), which goes on with the exchange
  FileTileStore* exchange() { return open(session_); }
  /// True if the disk of the maps has no room or is read-only.
  [[nodiscard]] bool disk_is_full() const;
  /// True while the folder of the present store is in its place.
  [[nodiscard]] bool in_place() const;
  [[nodiscard]] FileTileStore* current() { return store_.get(); }
  /// Journal of the present map; null when no folder is configured or the disk has refused it.
  [[nodiscard]] ScanJournal* journal() { return journal_ ? &*journal_ : nullptr; }
  /// Reads the scans of the journal of the present map, in their order.
  /// @return their number
  std::size_t read_journal(const std::function<void(const RegisteredScan&)>& visit);

  /// Posts what was written to flush().
  void post_for_flush() noexcept;
  /// Waits until the tiles and the scans that were posted are on the disk. False if the disk refuses. For another
  /// thread than that of the map.
  bool flush() noexcept;
  /// The whole map has been written to the tiles: waits for the disk, and removes the journal. The thread of the
  /// map.
  void finish() noexcept;

 private:
  std::filesystem::path first_;
  bool beside_ = true;  ///< folders of later frames are beside the first one, not inside
  MapHeader header_;
  TileStoreLimits limits_;
  std::uint32_t session_ = 1;
  std::unique_ptr<FileTileStore> store_;
  std::filesystem::path read_only_folder_;
  std::optional<ReadOnlyTiles> read_only_;
  std::optional<ScanJournal> journal_;
  DiskFlusher tile_flusher_;
  DiskFlusher scan_flusher_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// A map of an earlier session on the disk: where a run begins that is given one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/map/tile_storage.hpp"
#include "core/place/known_map.hpp"
#include "daemon/run_start.hpp"
#include "run/files/checkpoint.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// A stored map.
struct StoredMap {
  std::filesystem::path folder;  ///< of its tiles
  RunStart start;                ///< anywhere in it, as map frame 1
  bool has_datum = false;        ///< heights by air pressure go on in it
};

/// Finds the map in the folder of a map, or in that of a run, there of its newest map frame.
/// @param header grid of the configuration
/// @param stations base stations of this run: heights of another one are forgotten, see take_over_stations()
/// @throws DataError naming the file for a folder without a map, a map of another version of the format or with another grid,
/// and a damaged checkpoint
[[nodiscard]] StoredMap find_stored_map(const std::filesystem::path& folder, const MapHeader& header,
                                        const files::StationNames& stations);
/// What is to be known of the heights of a stored map at the start; empty: they go on.
[[nodiscard]] std::string height_note(const StoredMap& stored);

/// Copies the files of a map (tiles, journal, names of floors, checkpoint) to a folder that holds none.
/// @throws DataError for a folder that holds tiles; ServiceError when the disk refuses
void copy_map(const std::filesystem::path& from, const std::filesystem::path& to);

/// Reads all tiles.
[[nodiscard]] std::shared_ptr<const KnownMap> read_known_map(FileTileStore& store, std::uint32_t session);

/// Tiles that are read and never written: those of a map that is only used.
class ReadOnlyTiles final : public TileStorage {
 public:
  /// `store`: outlives this.
  explicit ReadOnlyTiles(FileTileStore& store) : store_(store) {}
  bool put(const TileKey& /*key*/, std::span<const std::byte> /*bytes*/) override { return true; }
  bool take(const TileKey& key, std::vector<std::byte>& bytes) override { return store_.take(key, bytes); }
  [[nodiscard]] bool contains(const TileKey& key) const override { return store_.contains(key); }

 private:
  FileTileStore& store_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "run/building/building_store.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Files of the loop stage in the folders of the maps: the building of the present map frame, and the next map while it is
/// laid. One thread.
class LoopFiles {
 public:
  /// Folder of the map of a map frame.
  using MapFolder = std::function<std::filesystem::path(std::uint32_t session)>;
  LoopFiles(MapFolder map_folder, const MapHeader& header, const TileStoreLimits& limits, double max_disk_gb);

  /// Opens the building of a map frame, instead of the present one.
  /// @return null where it is refused: see problem()
  BuildingStore* open(std::uint32_t session);
  [[nodiscard]] BuildingStore* building() { return building_.get(); }
  /// Creates the store of the next map of the present map frame.
  /// @return null where it is refused: see problem()
  TileStorage* begin_next_map();
  /// All tiles are in it; it is closed, and may take the place of the map. False where the disk refuses: see problem().
  bool complete_next_map();
  /// The last refusal; empty: none.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  MapFolder map_folder_;
  MapHeader header_;
  TileStoreLimits limits_;
  std::uint64_t max_bytes_;
  std::filesystem::path folder_;
  std::unique_ptr<BuildingStore> building_;
  std::unique_ptr<FileTileStore> next_map_;
  std::string problem_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/checkpoint_draft.hpp"
#include "daemon/lock_step.hpp"
#include "daemon/stored_map.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Maps of a replay on the disk: a new one in the folder of the run, or a stored one as map.stored and map.use say. A folder
/// per map frame.
class ReplayMaps {
 public:
  /// Opens the stored map, copies it, or creates an empty one. `out`: folder of the run.
  /// @throws DataError for a stored map that cannot be used; ConfigError for map.use = localise without a map; ServiceError
  /// when the disk refuses
  ReplayMaps(const Config& config, const std::filesystem::path& out);

  /// For the pipeline's first map frame.
  [[nodiscard]] TileStorage* storage();
  /// Keeps the building of each map frame. Null where the map is only used.
  [[nodiscard]] std::unique_ptr<LoopFiles> loop_files(const Config& config) const;
  /// Puts the map of the newest frame that was laid anew in its place, and opens it.
  TileStorage* exchange();
  /// Begins where the map says; to be called before the first event. Adds what is to be known to `notes`.
  void begin(LockStep& pipeline, std::vector<std::string>& notes);
  /// Writes where a later run goes on beside the tiles of a map that is the run's own.
  /// @throws ServiceError when the disk refuses
  void write_checkpoint(const CheckpointDraft& last, const HeightDatum& datum) const;
  /// The map of the newest frame.
  [[nodiscard]] FileTileStore& store() { return *stores_.back(); }

 private:
  [[nodiscard]] bool localises() const { return use_ == MapUse::kLocalise; }
  TileStorage* create(std::uint32_t session);

  std::filesystem::path out_;
  MapHeader header_;
  TileStoreLimits limits_;
  MapUse use_;
  std::optional<StoredMap> stored_;
  std::uint32_t newest_ = 1;                            ///< map frame
  std::vector<std::unique_ptr<FileTileStore>> stores_;  ///< the newest last; never empty
  std::optional<ReadOnlyTiles> read_only_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// What a run leaves behind: trajectory, status, counters, map, settings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/estimates.hpp"
#include "run/files/map_export.hpp"
#include "run/files/replay_output.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Something that was counted during a run, with the first case in words.
struct RunCount {
  std::string name;
  std::uint64_t count = 0;
  std::string first_message;
};

/// Writes the folder of a run while it goes on. One thread. Throws ServiceError when the disk refuses.
class RunOutput {
 public:
  explicit RunOutput(const std::filesystem::path& directory);
  /// Where the tiles of the map belong.
  [[nodiscard]] static std::filesystem::path map_directory(const std::filesystem::path& directory) {
    return directory / "map";
  }

  void add_pose(const PoseEstimate& pose, const Prior& prior);
  /// map.ply, at the end of the run, of all that is in the store of the run. Returns what was done.
  MapExport write_map(TileStore& store, const MapHeader& header);
  void write_settings(std::string_view toml) const { poses_.write_settings(toml); }
  void close(const std::vector<RunCount>& counts);

  [[nodiscard]] std::uint64_t poses() const { return poses_.count(); }
  [[nodiscard]] std::uint64_t registered() const { return registered_; }
  [[nodiscard]] std::uint64_t from_prior() const { return from_prior_; }
  [[nodiscard]] std::uint64_t map_points() const { return map_.count(); }

 private:
  std::filesystem::path directory_;
  files::ReplayOutputWriter poses_;
  files::PlyWriter map_;  ///< without a point until the end, so that no earlier run's is taken for this one's
  std::uint64_t registered_ = 0;
  std::uint64_t from_prior_ = 0;
};

}  // namespace isobar

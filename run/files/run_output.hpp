// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/estimates.hpp"
#include "run/files/map_export.hpp"
#include "run/files/ply_writer.hpp"
#include "run/files/pose_writer.hpp"
#include "run/files/run_layout.hpp"

namespace isobar::files {

/// A named counter of a run, with the message of its first event.
struct RunCount {
  std::string name;
  std::uint64_t count = 0;
  std::string first_message;
};

/// Writes the folder of a run (run_layout.hpp) during the run. One thread.
/// @throws ServiceError naming the file when writing fails
class RunOutput {
 public:
  explicit RunOutput(const std::filesystem::path& directory);
  /// Folder for the tile store of the run.
  [[nodiscard]] static std::filesystem::path map_directory(const std::filesystem::path& directory) {
    return directory / kMapDirectory;
  }

  void add_pose(const PoseEstimate& pose, const Prior& prior);
  /// Writes map.ply from the run's tile store, at the end of the run.
  MapExport write_map(FileTileStore& store, const MapHeader& header);
  /// Writes settings.toml.
  void write_settings(std::string_view toml) const;
  /// Writes counters.csv and closes all files.
  void close(const std::vector<RunCount>& counts);

  [[nodiscard]] std::uint64_t poses() const { return poses_.count(); }
  [[nodiscard]] std::uint64_t registered() const { return registered_; }
  [[nodiscard]] std::uint64_t from_prior() const { return from_prior_; }
  [[nodiscard]] std::uint64_t map_points() const { return map_.count(); }

 private:
  std::filesystem::path directory_;
  PoseWriter poses_;
  PlyWriter
      map_;  ///< opened at the start, so that an earlier run's map.ply cannot be mistaken for this run's
  std::uint64_t registered_ = 0;
  std::uint64_t from_prior_ = 0;
};

}  // namespace isobar::files

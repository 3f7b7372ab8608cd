// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/estimates.hpp"
#include "run/files/map_export.hpp"
#include "run/files/point_file.hpp"
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
/// @throws ServiceError naming the file when writing fails; a later call tries again
class RunOutput {
 public:
  /// @param start kNew replaces the trajectory of an earlier run, kContinue appends to it
  /// @param session number of the map frame of the first pose
  explicit RunOutput(const std::filesystem::path& directory, Start start = Start::kNew,
                     std::uint32_t session = 1);
  /// Folder for the tile store of a map frame.
  [[nodiscard]] static std::filesystem::path map_directory(const std::filesystem::path& directory,
                                                           std::uint32_t session = 1) {
    return directory / name_of_session(kMapDirectory, session);
  }

  /// Takes a pose; the files of another map frame begin with its first pose. Writes when a replay has
  /// gathered enough lines, and leaves it to flush() in a run that continues.
  void add_pose(const PoseEstimate& pose, const Prior& prior);
  /// Writes the lines to the files.
  void flush() { poses_->flush(); }
  /// Waits until the lines are on the disk.
  void sync() { poses_->sync(); }
  /// Replaces map.ply by the points of the map, at the end of the run.
  MapExport write_map(FileTileStore& store, const MapHeader& header);
  /// Writes settings.toml.
  void write_settings(std::string_view toml) const;
  /// Writes mounts.toml.
  void write_mounts(std::string_view toml) const;
  /// Writes counters.csv.
  void write_counters(const std::vector<RunCount>& counts) const;

  [[nodiscard]] std::uint64_t poses() const { return pose_count_; }
  [[nodiscard]] std::uint64_t registered() const { return registered_; }
  [[nodiscard]] std::uint64_t from_prior() const { return from_prior_; }
  [[nodiscard]] std::uint64_t map_points() const { return map_points_; }
  [[nodiscard]] std::uint64_t dropped_lines() const { return dropped_before_ + poses_->dropped_lines(); }
  [[nodiscard]] std::uint64_t removed_bytes() const { return poses_->removed_bytes(); }

 private:
  void follow_session(std::uint32_t session);

  std::filesystem::path directory_;
  Start start_;
  std::uint32_t session_;
  std::unique_ptr<PoseWriter> poses_;  ///< never null
  std::uint64_t dropped_before_ = 0;   ///< lines of earlier map frames
  std::uint64_t pose_count_ = 0;
  std::uint64_t registered_ = 0;
  std::uint64_t from_prior_ = 0;
  std::uint64_t map_points_ = 0;
};

}  // namespace isobar::files

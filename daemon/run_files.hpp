// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "config/config.hpp"
#include "daemon/health.hpp"
#include "daemon/loop_stage.hpp"
#include "daemon/map_stores.hpp"
#include "daemon/run_start.hpp"
#include "run/files/checkpoint.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

/// Files of a live run: the run folder of [output] and the tiles of the map, each only if configured. A folder
/// with an earlier run is continued: nothing in it is replaced but map.ply, counters.csv and settings.toml. An
/// earlier run that cannot be continued is kept, and a new map frame begins beside it. Main thread only;
/// output() and maps() belong to the output thread and the map thread while these run.
class RunFiles {
 public:
  /// Creates or continues the folders and writes the settings of the run.
  /// @throws ConfigError for a folder with files of others
  /// @throws ServiceError when the disk refuses, or another process writes there
  explicit RunFiles(const Config& config);

  [[nodiscard]] const RunStart& start() const noexcept { return start_; }
  [[nodiscard]] files::RunOutput* output() noexcept {
    return output_ ? &*output_ : nullptr;
  }  ///< null: none configured
  [[nodiscard]] MapStores& maps() noexcept { return maps_; }
  /// Names of the base stations that the run listens to.
  [[nodiscard]] const files::StationNames& stations() const noexcept { return stations_; }
  /// Folder of the map of a map frame; may be asked by any thread.
  [[nodiscard]] LoopFiles::MapFolder map_folder() const {
    return [this](std::uint32_t session) { return maps_.folder_of(session); };
  }
  /// Files of the loops, in the folders of the maps.
  [[nodiscard]] std::unique_ptr<LoopFiles> loop_files(const Config& config) const;
  [[nodiscard]] const MapStores& maps() const noexcept { return maps_; }
  /// The run stays in the stored map, which is only read.
  [[nodiscard]] bool stays() const noexcept { return maps_.read_only(); }
  /// File of the checkpoint; empty: nothing is configured that a later run could continue.
  [[nodiscard]] std::filesystem::path checkpoint_file() const;

  /// Writes the last poses, map.ply, counters.csv, mounts.toml and the corrected trajectory. What the disk refuses is logged. Call once, after all
  /// threads have stopped.
  /// @param loops what the run has found; may be null. It may lay the map anew for kMostLayingS.
  void close(const StatusSnapshot& last, LoopStage* loops);
  static constexpr double kMostLayingS = 3.0;  ///< systemd waits for 10 s

 private:
  [[nodiscard]] std::uint32_t newest_session() const;
  void choose_start();
  void choose_stored_start(const Config& config);
  [[nodiscard]] bool awaits_first_pose(std::uint32_t newest) const;
  void localise_in(const std::string& folder, const MapHeader& header);
  [[nodiscard]] std::optional<files::Checkpoint> read_own_checkpoint() const;
  void continue_from(files::Checkpoint checkpoint);
  void start_in(const StoredMap& stored);
  [[nodiscard]] bool begun(std::uint32_t session);
  [[nodiscard]] bool open_map(std::uint32_t session);
  void lay_map(LoopStage& loops);
  void begin_beside(std::uint32_t session, const std::string& why);

  std::filesystem::path directory_;
  Eigen::Vector3d configured_rpy_deg_;
  files::StationNames stations_;
  MapStores maps_;
  RunStart start_;
  std::optional<files::RunOutput> output_;
};

}  // namespace isobar

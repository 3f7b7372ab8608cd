// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/estimates.hpp"
#include "core/loops/building.hpp"
#include "core/loops/map_mover.hpp"
#include "core/loops/pose_corrections.hpp"
#include "daemon/loop_files.hpp"
#include "daemon/stage_settings.hpp"

namespace isobar {

/// Corrections of the poses of a map frame by the loops in it.
struct SessionCorrections {
  std::uint32_t session = 1;
  PoseCorrections corrections;
};

/// Loops as a stage: registered scans and priors in, corrections of the trajectory and of the map out. A building for each
/// map frame. Live runs (LoopThread) and replay (LockStep) run this same object. Not on the way of a scan: it allocates,
/// reads and writes files, and takes up to seconds once loops are found in a large building. One thread.
class LoopStage {
 public:
  /// `files`: null: nothing is stored, and the map is not moved.
  explicit LoopStage(const StageSettings& settings, std::unique_ptr<LoopFiles> files = nullptr);

  /// Takes a prior; in order of time. The last one before a scan has the height of the air at it.
  void add_prior(const Prior& prior) { prior_ = prior; }
  /// Stamp of the last prior; 0: none yet.
  [[nodiscard]] std::int64_t prior_ns() const { return prior_.stamp_ns; }
  /// @return the map, where it has been laid anew: its folder waits to be put in place (settle_next_map())
  std::optional<MovedMap> add_scan(const RegisteredScan& scan);
  /// The end of a run: lays the map where that is due, as long as `may_go_on`. What is not finished the next run does.
  std::optional<MovedMap> finish(const std::function<bool()>& may_go_on);

  /// Of every map frame so far.
  [[nodiscard]] std::vector<SessionCorrections> corrections() const;
  /// Sums over all map frames.
  [[nodiscard]] BuildingCounts counts() const;
  /// Times that the map was laid anew.
  [[nodiscard]] std::uint64_t moves() const { return moves_; }
  /// Why something is not stored, or the map is not moved; empty: nothing was refused.
  [[nodiscard]] std::string problem() const;

 private:
  void begin_building(std::uint32_t session);
  [[nodiscard]] std::optional<AirHeight> air() const;
  void begin_move();
  std::optional<MovedMap> step_move();

  LoopConfig config_;
  MapConfig map_;
  RegistrationConfig registration_;
  Eigen::Isometry3d T_base_lidar_;
  std::unique_ptr<LoopFiles> files_;
  Prior prior_;
  std::uint32_t session_ = 0;           // of building_; 0: no scan yet
  std::unique_ptr<Building> building_;  // null: no scan yet, or switched off
  std::optional<MapMover> mover_;       // none: nothing is stored
  MapMove move_;                        // of the map that was handed out last
  std::uint64_t moves_ = 0;
  bool look_ = false;  // whether a move is due
  std::vector<SessionCorrections> ended_;
  BuildingCounts ended_counts_;
};

/// Writes the corrected trajectory of every map frame into the folder of a run whose trajectories are on the disk.
/// @throws DataError, ServiceError as files::write_corrected_trajectory()
void write_corrected_trajectories(const std::filesystem::path& directory, const LoopStage& loops);

}  // namespace isobar

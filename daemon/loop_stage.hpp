// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/estimates.hpp"
#include "core/loops/building.hpp"
#include "core/loops/pose_corrections.hpp"
#include "daemon/stage_settings.hpp"

namespace isobar {

/// Corrections of the poses of a map frame by the loops in it.
struct SessionCorrections {
  std::uint32_t session = 1;
  PoseCorrections corrections;
};

/// Loops as a stage: registered scans and priors in, corrections of the trajectory out. A building for each map frame.
/// Live runs (LoopThread) and replay (LockStep) run this same object. Not on the way of a scan: it allocates, and takes up
/// to seconds once loops are found in a large building. One thread.
class LoopStage {
 public:
  explicit LoopStage(const StageSettings& settings);

  /// Takes a prior; in order of time. The last one before a scan has the height of the air at it.
  void add_prior(const Prior& prior) { prior_ = prior; }
  /// Stamp of the last prior; 0: none yet.
  [[nodiscard]] std::int64_t prior_ns() const { return prior_.stamp_ns; }
  void add_scan(const RegisteredScan& scan);

  /// Of every map frame so far.
  [[nodiscard]] std::vector<SessionCorrections> corrections() const;
  /// Sums over all map frames.
  [[nodiscard]] BuildingCounts counts() const;

 private:
  [[nodiscard]] std::optional<AirHeight> air() const;

  LoopConfig config_;
  MapConfig map_;
  RegistrationConfig registration_;
  Eigen::Isometry3d T_base_lidar_;
  Prior prior_;
  std::uint32_t session_ = 0;           // of building_; 0: no scan yet
  std::unique_ptr<Building> building_;  // null: no scan yet, or switched off
  std::vector<SessionCorrections> ended_;
  BuildingCounts ended_counts_;
};

/// Writes the corrected trajectory of every map frame into the folder of a run whose trajectories are on the disk.
/// @throws DataError, ServiceError as files::write_corrected_trajectory()
void write_corrected_trajectories(const std::filesystem::path& directory, const LoopStage& loops);

}  // namespace isobar

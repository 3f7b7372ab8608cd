// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/loop_stage.hpp"

#include "run/files/corrected_trajectory.hpp"

namespace isobar {

LoopStage::LoopStage(const StageSettings& settings)
    : config_(settings.loops),
      map_(settings.map),
      registration_(settings.registration),
      T_base_lidar_(settings.T_base_lidar) {}

void LoopStage::add_scan(const RegisteredScan& scan) {
  if (!config_.enabled) return;
  if (scan.pose.session != session_) {
    ended_ = corrections();
    ended_counts_ = counts();
    session_ = scan.pose.session;
    prior_ = Prior{};  // a new map frame may begin because the clock of the inputs has started over
    building_ = std::make_unique<Building>(config_, map_, registration_, T_base_lidar_);
  }
  building_->add(scan, air());
}

// Without a base station the weather moves the height: then the scans alone tell it.
std::optional<AirHeight> LoopStage::air() const {
  if (prior_.height_source != HeightSource::kDifferential) return std::nullopt;
  return AirHeight{prior_.height_m, prior_.height_variance_m2};
}

std::vector<SessionCorrections> LoopStage::corrections() const {
  std::vector<SessionCorrections> corrections = ended_;
  if (building_) corrections.push_back({session_, PoseCorrections(building_->corrections())});
  return corrections;
}

BuildingCounts LoopStage::counts() const {
  return building_ ? ended_counts_ + building_->counts() : ended_counts_;
}

void write_corrected_trajectories(const std::filesystem::path& directory, const LoopStage& loops) {
  for (const SessionCorrections& of : loops.corrections()) {
    files::write_corrected_trajectory(directory, of.session,
                                      [&](std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) {
                                        return of.corrections.corrected(stamp_ns, T_map_base);
                                      });
  }
}

}  // namespace isobar

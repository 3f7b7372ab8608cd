// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/loop_stage.hpp"

#include <utility>

#include "run/files/corrected_trajectory.hpp"

namespace isobar {

LoopStage::LoopStage(const StageSettings& settings, std::unique_ptr<LoopFiles> files)
    : config_(settings.loops),
      map_(settings.map),
      registration_(settings.registration),
      T_base_lidar_(settings.T_base_lidar),
      files_(std::move(files)) {}

std::optional<MovedMap> LoopStage::add_scan(const RegisteredScan& scan) {
  if (!config_.enabled) return std::nullopt;
  if (scan.pose.session != session_) begin_building(scan.pose.session);
  look_ = building_->add(scan, air()) || look_;
  begin_move();
  return step_move();
}

std::optional<MovedMap> LoopStage::finish(const std::function<bool()>& may_go_on) {
  if (!building_) return std::nullopt;
  begin_move();
  while (mover_ && mover_->active() && may_go_on()) {
    if (auto moved = step_move()) return moved;
  }
  return std::nullopt;
}

void LoopStage::begin_building(std::uint32_t session) {
  ended_ = corrections();
  ended_counts_ = counts();
  session_ = session;
  prior_ = Prior{};  // a new map frame may begin because the clock of the inputs has started over
  move_ = {};
  mover_.reset();
  building_.reset();
  BuildingStore* store = files_ ? files_->open(session) : nullptr;
  building_ = std::make_unique<Building>(config_, map_, registration_, T_base_lidar_, store);
  if (store == nullptr) return;
  building_->continue_from(std::move(store->stored()));
  look_ = true;
  if (config_.move.least_m > 0.0) mover_.emplace(config_.move, map_, T_base_lidar_, *store);
}

void LoopStage::begin_move() {
  if (!look_ || !mover_ || mover_->active() || building_->expects_move()) return;
  look_ = false;
  if (!mover_->is_due(*building_)) return;
  if (TileStorage* tiles = files_->begin_next_map()) mover_->begin(*building_, *tiles, session_);
}

// The tiles are whole before anybody hears of the map.
std::optional<MovedMap> LoopStage::step_move() {
  if (!mover_ || !mover_->active()) return std::nullopt;
  std::optional<MovedMap> moved = mover_->step(*building_, move_);
  if (!moved) return moved;
  moved->map->change_storage(nullptr);
  if (!files_->complete_next_map()) return std::nullopt;
  building_->expect_move(moved->T_now_before);
  move_ = moved->map->move();
  ++moves_;
  return moved;
}

std::string LoopStage::problem() const {
  if (!files_) return {};
  if (!files_->problem().empty()) return files_->problem();
  if (mover_ && !mover_->problem().empty()) return mover_->problem();
  return files_->building() != nullptr ? files_->building()->counters().first_refusal : std::string{};
}

// Without a base station the weather moves the height: then the scans alone tell it.
std::optional<AirHeight> LoopStage::air() const {
  if (prior_.height_source != HeightSource::kDifferential) return std::nullopt;
  return AirHeight{prior_.height_m, prior_.height_variance_m2};
}

std::vector<SessionCorrections> LoopStage::corrections() const {
  std::vector<SessionCorrections> corrections = ended_;
  if (building_)
    corrections.push_back({session_, PoseCorrections(building_->corrections(), building_->moved_ns())});
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

// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/floor_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ipc/status.hpp"

namespace isobar {

namespace {

constexpr double kSameFloorM = 1.0;
constexpr double kSureHeightM = 0.3;  // sigma of a height by which a floor is opened

double height_sigma_m(const PoseEstimate& pose) { return std::sqrt(std::max(pose.covariance(2, 2), 0.0)); }

bool has_place(const PoseEstimate& pose) {
  return pose.mode != PoseMode::kInitializing && pose.lost == LostReason::kNone;
}

}  // namespace

void FloorStage::begin(std::uint32_t session, std::span<const Eigen::Vector3d> earlier_path) {
  session_ = session;
  map_moves_ = 0;
  map_ = FloorMap(grid_);
  names_ = {};
  pose_ = {};
  last_.reset();
  for (const Eigen::Vector3d& place : earlier_path) map_.drive_to(place);
}

void FloorStage::add_pose(const PoseEstimate& pose) {
  if (pose.session != session_) begin(pose.session, {});
  if (pose.map_moves != map_moves_) map_.forget_tiles();
  map_moves_ = pose.map_moves;
  pose_ = pose;
  if (!has_place(pose)) return;
  if (height_sigma_m(pose) <= kSureHeightM) {
    map_.arrive_at(pose.stamp_ns, pose.T_map_base.translation());
  } else {
    map_.drive_to(pose.T_map_base.translation());
  }
}

void FloorStage::add_tiles(const FloorTiles& tiles) {
  if (tiles.session != session_ || tiles.map_moves != map_moves_) return;
  for (const FloorTile& tile : tiles.tiles) map_.set_tile(tile.key, tile.points);
}

// The floor that was known last goes on by its height: its number changes when a floor between two known ones is found.
void FloorStage::find() {
  map_.find();
  if (!last_) return;
  const auto distance_m = [this](const Floor& floor) { return std::abs(floor.height_m - last_->height_m); };
  const std::vector<Floor>& floors = map_.floors().floors;
  const auto nearest = std::min_element(floors.begin(), floors.end(), [&](const Floor& a, const Floor& b) {
    return distance_m(a) < distance_m(b);
  });
  if (nearest != floors.end() && distance_m(*nearest) < kSameFloorM) last_ = *nearest;
}

ipc::CurrentFloor FloorStage::current() {
  ipc::CurrentFloor current;
  current.stamp_ns = pose_.stamp_ns;
  current.session = session_;
  if (has_place(pose_)) {
    const FloorGuess guess = floor_at(map_.floors(), pose_.T_map_base.translation(), height_sigma_m(pose_));
    current.place = guess.place;
    current.known = guess.place == FloorPlace::kOnFloor;
    current.certainty = guess.certainty;
    if (current.known) last_ = *guess.floor;
  }
  current.number = last_ ? last_->number : 0;
  current.z_m = last_ ? last_->height_m : std::numeric_limits<double>::quiet_NaN();
  ipc::copy_text(last_ ? names_.name_of(*last_) : std::string(), current.name, sizeof(current.name));
  return current;
}

ipc::KnownFloors FloorStage::known() const {
  ipc::KnownFloors known;
  known.session = session_;
  for (const Floor& floor : map_.floors().floors) {
    if (known.count == ipc::KnownFloors::kMost) break;
    ipc::KnownFloor& told = known.floors[known.count++];
    told.number = floor.number;
    told.z_m = floor.height_m;
    ipc::copy_text(names_.name_of(floor), told.name, sizeof(told.name));
  }
  return known;
}

std::optional<OccupancyGrid> FloorStage::grid() const {
  if (!last_) return std::nullopt;
  return map_.grid(*last_);
}

}  // namespace isobar

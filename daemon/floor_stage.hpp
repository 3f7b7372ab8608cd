// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "config/config.hpp"
#include "core/estimates.hpp"
#include "core/floors/floor_map.hpp"
#include "daemon/floor_feed.hpp"
#include "ipc/floors.hpp"
#include "run/floors/floor_names.hpp"

namespace isobar {

/// Floors as a stage: poses and points of the map in; the floor that the robot is on, and its grid, out. A map frame begins
/// with an empty map. Not on the way of a scan: it allocates, and find() and grid() take up to seconds in a large map. One
/// thread.
class FloorStage {
 public:
  explicit FloorStage(const GridConfig& grid) : grid_(grid), map_(grid) {}

  /// Begins a map frame; its earlier poses, of a run that is continued, in order of time [m].
  void begin(std::uint32_t session, std::span<const Eigen::Vector3d> earlier_path);
  /// Takes a pose; the way of a robot that is lost is none.
  void add_pose(const PoseEstimate& pose);
  /// Takes tiles; those of another map frame are left out.
  void add_tiles(const FloorTiles& tiles);
  void set_names(files::FloorNames names) { names_ = std::move(names); }

  /// Finds the floors anew.
  void find();
  /// The floor at the newest pose, among those of the last find().
  [[nodiscard]] ipc::CurrentFloor current();
  /// The floors of the last find(), with their names.
  [[nodiscard]] ipc::KnownFloors known() const;
  /// Grid of the floor that was known last; none without one.
  /// @throws DataError when it is too large
  [[nodiscard]] std::optional<OccupancyGrid> grid() const;

  [[nodiscard]] std::uint32_t session() const { return session_; }
  /// Corrections of the map frame, see MapMove: with each all tiles come again.
  [[nodiscard]] std::uint32_t map_moves() const { return map_moves_; }
  /// Of the newest pose [m].
  [[nodiscard]] Eigen::Vector3d p_map_base() const { return pose_.T_map_base.translation(); }
  [[nodiscard]] const FloorMap& map() const { return map_; }

 private:
  GridConfig grid_;
  FloorMap map_;
  files::FloorNames names_;
  std::uint32_t session_ = 0;  ///< 0: none yet
  std::uint32_t map_moves_ = 0;
  PoseEstimate pose_;
  std::optional<Floor> last_;  ///< the floor that was known last
};

}  // namespace isobar

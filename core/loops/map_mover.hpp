// SPDX-License-Identifier: BSD-3-Clause
// The map of the run, laid anew at corrected poses:
//
//     loops correct the building ─▶ due? ─▶ key scans, some a step, in order of time ─▶ a new map, and how it moved
//
// The cells of a map cannot be moved one by one: those of two visits lie in one another. Key scans can.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/loops/building.hpp"
#include "core/loops/building_storage.hpp"
#include "core/loops/loop_config.hpp"
#include "core/map/local_map.hpp"
#include "core/map/map_move.hpp"

namespace isobar {

/// A map that takes the place of the one before.
struct MovedMap {
  std::unique_ptr<LocalMap> map;  ///< around the last key scan; all of it is in the storage as well
  Eigen::Isometry3d T_now_before = Eigen::Isometry3d::Identity();  ///< of the robot's pose, about z
};

/// Lays maps anew. One thread, not real-time.
class MapMover {
 public:
  /// `storage`: has the scans. Outlives the mover.
  MapMover(const MapMoveConfig& config, const MapConfig& map, const Eigen::Isometry3d& T_base_lidar,
           BuildingStorage& storage);

  /// A way for which key scans of the building lie farther than MapMoveConfig::least_m or least_deg from where the map has
  /// them; not while a map is laid.
  [[nodiscard]] bool is_due(const Building& building) const;
  /// Begins to lay the map at the present poses of the building.
  /// @param tiles receives all tiles; outlives the map
  void begin(const Building& building, TileStorage& tiles, std::uint32_t session);
  [[nodiscard]] bool active() const { return map_ != nullptr; }
  /// Lays some key scans. Those of submaps that have begun since begin() follow their chain.
  /// @return the map, with all tiles in `tiles`, once the last key scan is in it
  std::optional<MovedMap> step(const Building& building, const MapMove& before);
  /// Why the map is not moved any more: the storage lacks its scans. Empty: it may be.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  void lay(const KeyScan& key, const Eigen::Isometry3d& T_map_submap);
  [[nodiscard]] std::optional<MovedMap> finish(const Building& building, const MapMove& before);

  MapMoveConfig config_;
  MapConfig map_config_;
  Eigen::Isometry3d T_base_lidar_;
  BuildingStorage& storage_;
  std::unique_ptr<RegisteredScan> scan_;
  std::unique_ptr<LocalMap> map_;                // null: none is laid
  std::vector<Eigen::Isometry3d> T_map_submap_;  // by number, at which it is laid
  std::size_t submap_ = 0;                       // the next key scan to be laid
  std::size_t key_ = 0;
  std::vector<Eigen::Isometry3d> T_laid_;  // T_map_submap_ of the map in use; empty: it lies as it was driven
  std::int64_t laid_ns_ = 0;               // stamp of its last key scan
  std::size_t laid_keys_ = 0;
  std::size_t missing_ = 0;  // key scans whose scan cannot be read
  std::string problem_;
};

}  // namespace isobar

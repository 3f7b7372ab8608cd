// SPDX-License-Identifier: BSD-3-Clause
// Immutable snapshot of the map for the registration: the interface of the two matchers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/map/grid.hpp"
#include "core/map/map_move.hpp"

namespace isobar {

/// Parameters of a match, common to all points of a call.
struct MatchQuery {
  LocalFrame frame;                                           ///< of points, viewpoint and matches
  Eigen::Vector3f viewpoint_local = Eigen::Vector3f::Zero();  ///< only planes that face it are matched [m]
  float max_distance_m = 0.0F;                                ///< from a point to the plane's point
};

/// Result of the match of one point, and the matcher's cache for the next call with the same point.
struct PlaneMatch {
  Eigen::Vector3f q_local = Eigen::Vector3f::Zero();  ///< the plane's point [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();   ///< the plane's unit normal, towards the observer
  bool found = false;
  bool in_own_cell = false;  ///< the plane is that of the point's own cell, and not extrapolated to the point

  // Cache: written and read by the matcher only.
  CellIndex cell = CellIndex::Zero();  ///< cell of the point in the last call
  Eigen::Vector3f p_searched =
      Eigen::Vector3f::Zero();  ///< point at the last search for the nearest plane [m]
  bool nearest_known = false;   ///< that search found a plane
  float clear_m = 0.0F;         ///< lower bound of the distance from p_searched to all other planes [m]
};

/// Base class of the snapshots, and the snapshot of an empty map. Immutable: any number of threads may read
/// it at the same time.
class MapSnapshot {
 public:
  MapSnapshot() = default;
  /// An empty map.
  explicit MapSnapshot(std::uint32_t session) : session_(session) {}
  virtual ~MapSnapshot() = default;
  MapSnapshot(const MapSnapshot&) = delete;
  MapSnapshot& operator=(const MapSnapshot&) = delete;

  /// Matches each of the N points `p_local` [m] to a plane. `matches` (N as well) is either default
  /// constructed, or the result of the last call for the same points, which may have moved, with the same
  /// snapshot and frame. Allocates nothing, takes no lock.
  virtual void match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
                     std::span<PlaneMatch> matches) const;

  [[nodiscard]] bool empty() const { return plane_count_ == 0; }
  /// Number of planes that can be matched.
  [[nodiscard]] std::size_t plane_count() const { return plane_count_; }
  /// Edge of a cell [m].
  [[nodiscard]] float cell_m() const { return cell_m_; }
  /// Number of the map frame, as in PoseEstimate.
  [[nodiscard]] std::uint32_t session() const { return session_; }
  /// How its map frame has been corrected so far.
  [[nodiscard]] const MapMove& move() const { return move_; }
  /// Before it is published.
  void set_move(const MapMove& move) { move_ = move; }

 protected:
  MapSnapshot(float cell_m, std::size_t plane_count, std::uint32_t session = 1)
      : session_(session), cell_m_(cell_m), plane_count_(plane_count) {}

 private:
  std::uint32_t session_ = 1;
  MapMove move_;
  float cell_m_ = 0.25F;
  std::size_t plane_count_ = 0;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// An immutable view of the map, as the registration sees it: the interface of the matchers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "core/map/grid.hpp"
#include "core/map/map_point.hpp"

namespace isobar {

/// Where the points are seen from and how far from the map they may be.
struct MatchQuery {
  LocalFrame frame;                                           ///< of the points and of the matches
  Eigen::Vector3f viewpoint_local = Eigen::Vector3f::Zero();  ///< a plane must face it
  float max_distance_m = 0.0F;                                ///< from a point to the plane's point
};

/// The plane of the map that a point belongs to, and what lets a matcher skip the search the next time.
struct PlaneMatch {
  Eigen::Vector3f q_local = Eigen::Vector3f::Zero();  ///< a point on the plane
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();   ///< unit normal towards the observer
  bool found = false;

  // What a matcher keeps for its next call.
  bool in_own_cell = false;                              ///< found by the cell alone
  bool nearest_known = false;                            ///< the plane is the nearest to p_searched
  CellIndex cell = CellIndex::Zero();                    ///< of the point then
  Eigen::Vector3f p_searched = Eigen::Vector3f::Zero();  ///< the point when planes around it were looked for
  float clear_m = 0.0F;  ///< there was no other plane within this distance of p_searched
};

/// A map that does not change. This class is the empty one. Any number of threads may read it at once.
class MapSnapshot {
 public:
  MapSnapshot() = default;
  virtual ~MapSnapshot() = default;
  MapSnapshot(const MapSnapshot&) = delete;
  MapSnapshot& operator=(const MapSnapshot&) = delete;

  /// Gives each of `p_local` the plane that it belongs to. `matches`, of the same length, is either new or
  /// what the last call with this snapshot, this frame and these points (moved since) left. No allocation, no
  /// lock.
  virtual void match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
                     std::span<PlaneMatch> matches) const;

  /// match() of one point in coordinates of the map. False, and `match` untouched, where there is no plane.
  bool nearest(const Eigen::Vector3d& p_map, const Eigen::Vector3d& viewpoint_map, double max_distance_m,
               MapMatch& match) const;

  [[nodiscard]] bool empty() const { return plane_count_ == 0; }
  /// Number of planes that can be matched.
  [[nodiscard]] std::size_t plane_count() const { return plane_count_; }
  [[nodiscard]] std::size_t tile_count() const { return tile_count_; }
  [[nodiscard]] float cell_m() const { return cell_m_; }

 protected:
  MapSnapshot(float cell_m, std::size_t plane_count, std::size_t tile_count)
      : cell_m_(cell_m), plane_count_(plane_count), tile_count_(tile_count) {}

 private:
  float cell_m_ = 0.25F;
  std::size_t plane_count_ = 0;
  std::size_t tile_count_ = 0;
};

}  // namespace isobar

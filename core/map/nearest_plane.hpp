// SPDX-License-Identifier: BSD-3-Clause
// Matcher: nearest plane by one k-d tree per tile. nearest_plane.cpp is the only file that includes
// nanoflann.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/map/map_snapshot.hpp"
#include "core/map/plane_block.hpp"
#include "core/map/tile_directory.hpp"

namespace isobar {

/// Immutable k-d tree over the planes of one tile.
class TileTree {
 public:
  TileTree(const PlaneTile& tile, float cell_m);
  ~TileTree();
  TileTree(const TileTree&) = delete;
  TileTree& operator=(const TileTree&) = delete;

  TileKey key;

  struct Plane {
    Eigen::Vector3f q_tile;  ///< the plane's point, from the tile's corner [m]
    Eigen::Vector3f normal;  ///< unit normal towards the observer
  };
  [[nodiscard]] std::size_t size() const { return planes_.size(); }

  /// Nearest plane to `p_tile` that faces `viewpoint_tile` and is closer than sqrt(squared_distance); null if
  /// there is none. `p_tile`, `viewpoint_tile`: from the tile's corner [m]. `squared_distance` [m^2] is
  /// lowered to that of the plane.
  const Plane* nearest(const Eigen::Vector3f& p_tile, const Eigen::Vector3f& viewpoint_tile,
                       float& squared_distance) const;

 private:
  struct Tree;
  std::vector<Plane> planes_;
  std::unique_ptr<Tree> tree_;
};

/// Matches a point to the plane whose point is nearest (the paper's data association).
class NearestPlane final : public MapSnapshot {
 public:
  /// `trees`: no null pointers. `session`: number of the map frame.
  NearestPlane(std::vector<std::shared_ptr<const TileTree>> trees, float cell_m, std::uint32_t session = 1);

  void match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
             std::span<PlaneMatch> matches) const override;

 private:
  bool match_one(const MatchQuery& query, const Eigen::Vector3f& p_local, PlaneMatch& match) const;

  TileDirectory<TileTree> directory_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Matcher: plane of the cell that contains the point, found by one hash lookup. If that cell has no plane
// that faces the robot and lies close to the point, the nearest plane of the cells around.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/map/map_snapshot.hpp"
#include "core/map/plane_block.hpp"
#include "core/map/tile_directory.hpp"

namespace isobar {

/// Matches a point to the plane of its cell, or else to the nearest plane.
class PlaneHash final : public MapSnapshot {
 public:
  /// `tiles`: no null pointers. `session`: number of the map frame.
  PlaneHash(std::vector<std::shared_ptr<const PlaneTile>> tiles, float cell_m, std::uint32_t session = 1);

  void match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
             std::span<PlaneMatch> matches) const override;

 private:
  class Search;
  TileDirectory<PlaneTile> directory_;
};

}  // namespace isobar

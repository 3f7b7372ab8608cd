// SPDX-License-Identifier: BSD-3-Clause
// Matcher: the plane of the cell that a point is in. One probe a point; only where its cell has no plane that
// faces the robot and lies near the point, the nearest one around.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/map/map_snapshot.hpp"
#include "core/map/plane_block.hpp"
#include "core/map/tile_directory.hpp"

namespace isobar {

class PlaneHash final : public MapSnapshot {
 public:
  /// `tiles` without null pointers.
  PlaneHash(std::vector<std::shared_ptr<const PlaneTile>> tiles, float cell_m);

  void match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
             std::span<PlaneMatch> matches) const override;

 private:
  class Search;
  TileDirectory<PlaneTile> directory_;
};

}  // namespace isobar

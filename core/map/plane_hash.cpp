// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_hash.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace isobar {

namespace {

// A point farther from its cell's plane than this [m] may belong to another one: at a corner, or while the
// pose is off. So the nearest plane around decides. Above the noise of lidar and map, 0.01 to 0.03 m, so that
// it is asked seldom.
constexpr float kOwnCellResidualM = 0.05F;

bool belongs(const PlaneMatch& match, const Eigen::Vector3f& p_local) {
  return std::abs(match.normal.dot(p_local - match.q_local)) < kOwnCellResidualM;
}

std::size_t count_planes(const std::vector<std::shared_ptr<const PlaneTile>>& tiles) {
  std::size_t count = 0;
  for (const auto& tile : tiles) {
    count += tile->plane_count;
  }
  return count;
}

}  // namespace

// One call of match(): remembers the tile of the last point, which is most often the next one's too.
class PlaneHash::Search {
 public:
  Search(const TileDirectory<PlaneTile>& directory, const MatchQuery& query)
      : directory_(directory),
        query_(query),
        squared_limit_m2_(query.max_distance_m * query.max_distance_m) {}

  // The plane of the point's own cell.
  bool own_cell(const CellIndex& cell, const Eigen::Vector3f& p_local, PlaneMatch& match) {
    const PlaneBlock* block = find_block(cell);
    if (block == nullptr) {
      return false;
    }
    const int place = place_of(cell);
    const Eigen::Vector3f centre_local = block_centre_local(query_.frame, first_of_block(cell));
    for (int side = 0; side < kSides; ++side) {
      float squared_m2 = squared_limit_m2_;
      const PackedPlane* plane = block->find(side * kPlacesPerBlock + place);
      if (plane != nullptr && take_if_nearer(*plane, centre_local, p_local, squared_m2, match)) {
        return belongs(match, p_local);
      }
    }
    return false;
  }

  // The plane whose point is nearest, among the cells that a ball of max_distance_m touches.
  bool around(const Eigen::Vector3f& p_local, PlaneMatch& match) {
    const CellIndex first = query_.frame.cell_of(p_local.array() - query_.max_distance_m);
    const CellIndex last = query_.frame.cell_of(p_local.array() + query_.max_distance_m);
    float squared_m2 = squared_limit_m2_;
    bool found = false;
    for_each_block(first, last,
                   [&](const CellIndex& block_first, const CellIndex& low, const CellIndex& high) {
                     const PlaneBlock* block = find_block(block_first);
                     if (block == nullptr) return;
                     const Eigen::Vector3f centre_local = block_centre_local(query_.frame, block_first);
                     for (int side = 0; side < kSides; ++side) {
                       for_each_in_window(block->mask, side, low, high, [&](int slot) {
                         const PackedPlane& plane = block->planes[block->mask.rank(slot)];
                         found = take_if_nearer(plane, centre_local, p_local, squared_m2, match) || found;
                       });
                     }
                   });
    return found;
  }

 private:
  const PlaneBlock* find_block(const CellIndex& cell) {
    const TileKey key = tile_of(cell);
    if (!known_ || key != key_) {
      tile_ = directory_.find(key);
      key_ = key;
      known_ = true;
    }
    return tile_ != nullptr ? tile_->blocks[block_of(cell)].get() : nullptr;
  }

  bool take_if_nearer(const PackedPlane& plane, const Eigen::Vector3f& centre_local,
                      const Eigen::Vector3f& p_local, float& squared_m2, PlaneMatch& match) const {
    const Eigen::Vector3f q_local = centre_local + plane.q_block(query_.frame.cell_m);
    const float distance2 = (q_local - p_local).squaredNorm();
    if (!(distance2 < squared_m2)) {
      return false;
    }
    const Eigen::Vector3f normal = plane.unit_normal();
    if (!(normal.dot(query_.viewpoint_local - q_local) > 0.0F)) {
      return false;
    }
    squared_m2 = distance2;
    match.q_local = q_local;
    match.normal = normal;
    return true;
  }

  const TileDirectory<PlaneTile>& directory_;
  const MatchQuery& query_;
  float squared_limit_m2_;
  TileKey key_;
  const PlaneTile* tile_ = nullptr;
  bool known_ = false;
};

PlaneHash::PlaneHash(std::vector<std::shared_ptr<const PlaneTile>> tiles, float cell_m)
    : MapSnapshot(cell_m, count_planes(tiles), tiles.size()), directory_(std::move(tiles)) {}

void PlaneHash::match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
                      std::span<PlaneMatch> matches) const {
  Search search(directory_, query);
  const float squared_limit_m2 = query.max_distance_m * query.max_distance_m;
  for (std::size_t i = 0; i < p_local.size(); ++i) {
    PlaneMatch& match = matches[i];
    const CellIndex cell = query.frame.cell_of(p_local[i]);
    // A point that stays in its cell keeps its plane.
    if (match.in_own_cell && match.cell == cell) {
      match.found =
          (match.q_local - p_local[i]).squaredNorm() < squared_limit_m2 && belongs(match, p_local[i]);
      if (match.found) continue;
    }
    match.cell = cell;
    match.in_own_cell = search.own_cell(cell, p_local[i], match);
    match.found = match.in_own_cell || search.around(p_local[i], match);
  }
}

}  // namespace isobar

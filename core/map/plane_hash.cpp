// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/plane_hash.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace isobar {

namespace {

// Maximum distance from a point to the plane of its own cell [m]. A point farther away may belong to another
// plane, at a corner or while the pose is still off, and the nearest plane is searched. Above the noise of
// lidar and map, 0.01 … 0.03 m, so that the search is rare.
constexpr float kOwnCellResidualM = 0.05F;

// Radius of the first search for the nearest plane [m]. A plane found within it is the nearest of all; the
// full radius, 0.8 m in the first iteration, intersects twice as many blocks.
constexpr float kFirstSearchRadiusM = 0.35F;

bool is_close_to_plane(const Eigen::Vector3f& p_local, const Eigen::Vector3f& q_local,
                       const Eigen::Vector3f& normal) {
  return std::abs(normal.dot(p_local - q_local)) < kOwnCellResidualM;
}

// True if the last search, made from match.p_searched, still holds for `p_local`; match.found is then updated
// for the distance limit `limit_m`. Triangle inequality: the distance to every other plane is at least
// match.clear_m minus the distance that the point has moved since.
bool last_search_holds(const Eigen::Vector3f& p_local, float limit_m, PlaneMatch& match) {
  const float clear_m = match.clear_m - (p_local - match.p_searched).norm();
  if (!match.nearest_known) {
    match.found = false;
    return clear_m >= limit_m;
  }
  const float distance_m = (match.q_local - p_local).norm();
  match.found = distance_m < limit_m;
  return distance_m <= clear_m;
}

std::size_t count_planes(const std::vector<std::shared_ptr<const PlaneTile>>& tiles) {
  std::size_t count = 0;
  for (const auto& tile : tiles) {
    count += tile->plane_count;
  }
  return count;
}

}  // namespace

// State of one call of match(): caches the last tile, since consecutive points are mostly in the same one.
class PlaneHash::Search {
 public:
  Search(const TileDirectory<PlaneTile>& directory, const MatchQuery& query)
      : directory_(directory),
        query_(query),
        squared_limit_m2_(query.max_distance_m * query.max_distance_m) {}

  // Plane of the point's own cell: the first of its sides that faces the viewpoint. False if none does or the
  // point is too far from it.
  bool own_cell(const CellIndex& cell, const Eigen::Vector3f& p_local, PlaneMatch& match) {
    const PlaneBlock* block = find_block(cell);
    if (block == nullptr) {
      return false;
    }
    const int place = place_of(cell);
    const Eigen::Vector3f centre_local = block_centre_local(query_.frame, first_of_block(cell));
    for (int side = 0; side < kSides; ++side) {
      const PackedPlane* packed = block->find(side * kPlacesPerBlock + place);
      if (packed == nullptr) continue;
      const Eigen::Vector3f q_local = centre_local + packed->q_block(query_.frame.cell_m);
      const Eigen::Vector3f normal = packed->unit_normal();
      if ((q_local - p_local).squaredNorm() < squared_limit_m2_ && faces(normal, q_local)) {
        if (!is_close_to_plane(p_local, q_local, normal)) return false;
        match.q_local = q_local;
        match.normal = normal;
        return true;
      }
    }
    return false;
  }

  // Nearest plane closer than max_distance_m.
  bool nearest(const Eigen::Vector3f& p_local, PlaneMatch& match) {
    return (query_.max_distance_m > kFirstSearchRadiusM &&
            nearest_within(kFirstSearchRadiusM, p_local, match)) ||
           nearest_within(query_.max_distance_m, p_local, match);
  }

 private:
  // Squared distances of the nearest and second nearest plane [m^2]; the squared search radius if there is
  // none.
  struct TwoNearest {
    float first_m2, second_m2;
  };

  // Nearest plane closer than `limit_m`, from the cells that the cube around that ball intersects.
  bool nearest_within(float limit_m, const Eigen::Vector3f& p_local, PlaneMatch& match) {
    const CellIndex first = query_.frame.cell_of(p_local.array() - limit_m);
    const CellIndex last = query_.frame.cell_of(p_local.array() + limit_m);
    TwoNearest nearest{limit_m * limit_m, limit_m * limit_m};
    for_each_block(first, last,
                   [&](const CellIndex& block_first, const CellIndex& low, const CellIndex& high) {
                     const PlaneBlock* block = find_block(block_first);
                     if (block == nullptr) return;
                     const Eigen::Vector3f centre_local = block_centre_local(query_.frame, block_first);
                     for (int side = 0; side < kSides; ++side) {
                       for_each_in_window(block->mask, side, low, high, [&](int slot) {
                         const PackedPlane& plane = block->planes[block->mask.rank(slot)];
                         take_if_nearer(plane, centre_local, p_local, nearest, match);
                       });
                     }
                   });
    match.p_searched = p_local;
    match.clear_m = std::sqrt(nearest.second_m2);
    match.nearest_known = nearest.first_m2 < limit_m * limit_m;
    return match.nearest_known;
  }

  const PlaneBlock* find_block(const CellIndex& cell) {
    const TileKey key = tile_of(cell);
    if (!known_ || key != key_) {
      tile_ = directory_.find(key);
      key_ = key;
      known_ = true;
    }
    return tile_ != nullptr ? tile_->blocks[block_of(cell)].get() : nullptr;
  }

  [[nodiscard]] bool faces(const Eigen::Vector3f& normal, const Eigen::Vector3f& q_local) const {
    return normal.dot(query_.viewpoint_local - q_local) > 0.0F;
  }

  void take_if_nearer(const PackedPlane& plane, const Eigen::Vector3f& centre_local,
                      const Eigen::Vector3f& p_local, TwoNearest& nearest, PlaneMatch& match) const {
    const Eigen::Vector3f q_local = centre_local + plane.q_block(query_.frame.cell_m);
    const float distance2 = (q_local - p_local).squaredNorm();
    if (!(distance2 < nearest.second_m2)) {
      return;
    }
    const Eigen::Vector3f normal = plane.unit_normal();
    if (!faces(normal, q_local)) {
      return;
    }
    if (!(distance2 < nearest.first_m2)) {
      nearest.second_m2 = distance2;
      return;
    }
    nearest = {distance2, nearest.first_m2};
    match.q_local = q_local;
    match.normal = normal;
  }

  const TileDirectory<PlaneTile>& directory_;
  const MatchQuery& query_;
  float squared_limit_m2_;
  TileKey key_;
  const PlaneTile* tile_ = nullptr;
  bool known_ = false;
};

PlaneHash::PlaneHash(std::vector<std::shared_ptr<const PlaneTile>> tiles, float cell_m, std::uint32_t session)
    : MapSnapshot(cell_m, count_planes(tiles), session), directory_(std::move(tiles)) {}

void PlaneHash::match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
                      std::span<PlaneMatch> matches) const {
  Search search(directory_, query);
  const float squared_limit_m2 = query.max_distance_m * query.max_distance_m;
  for (std::size_t i = 0; i < p_local.size(); ++i) {
    PlaneMatch& match = matches[i];
    const CellIndex cell = query.frame.cell_of(p_local[i]);
    // A point that stayed in its cell keeps the plane of that cell.
    if (match.in_own_cell && match.cell == cell &&
        (match.q_local - p_local[i]).squaredNorm() < squared_limit_m2 &&
        is_close_to_plane(p_local[i], match.q_local, match.normal)) {
      match.found = true;
      continue;
    }
    match.cell = cell;
    match.in_own_cell = search.own_cell(cell, p_local[i], match);
    if (match.in_own_cell) {
      match.found = true;
      match.nearest_known = false;
      match.clear_m = 0.0F;
    } else if (!last_search_holds(p_local[i], query.max_distance_m, match)) {
      match.found = search.nearest(p_local[i], match);
    }
  }
}

}  // namespace isobar

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

// A plane around a point is looked for this near [m] first: what is found there is the nearest of all, and a
// ball of 0.8 m, which the first iteration asks for, touches twice as many blocks.
constexpr float kNearM = 0.35F;

bool belongs(const Eigen::Vector3f& p_local, const Eigen::Vector3f& q_local, const Eigen::Vector3f& normal) {
  return std::abs(normal.dot(p_local - q_local)) < kOwnCellResidualM;
}

// True if what PlaneHash::Search::around() found, or did not find, from p_searched is the answer from here
// too; `match.found` then says whether it lies within `limit_m`. By the triangle inequality all other planes
// are farther than what was clear less the way since.
bool still_nearest(const Eigen::Vector3f& p_local, float limit_m, PlaneMatch& match) {
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

// One call of match(): remembers the tile of the last point, which is most often the next one's too.
class PlaneHash::Search {
 public:
  Search(const TileDirectory<PlaneTile>& directory, const MatchQuery& query)
      : directory_(directory),
        query_(query),
        squared_limit_m2_(query.max_distance_m * query.max_distance_m) {}

  // The plane of the point's own cell, if the point belongs to it.
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
        if (!belongs(p_local, q_local, normal)) return false;
        match.q_local = q_local;
        match.normal = normal;
        return true;
      }
    }
    return false;
  }

  // The plane whose point is nearest, if within max_distance_m.
  bool around(const Eigen::Vector3f& p_local, PlaneMatch& match) {
    return (query_.max_distance_m > kNearM && within(kNearM, p_local, match)) ||
           within(query_.max_distance_m, p_local, match);
  }

 private:
  // Squared distances of the nearest planes [m^2]; the limit where there is none.
  struct TwoNearest {
    float first_m2, second_m2;
  };

  // The plane whose point is nearest, among the cells that a ball of `limit_m` touches.
  bool within(float limit_m, const Eigen::Vector3f& p_local, PlaneMatch& match) {
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
    if (match.in_own_cell && match.cell == cell &&
        (match.q_local - p_local[i]).squaredNorm() < squared_limit_m2 &&
        belongs(p_local[i], match.q_local, match.normal)) {
      match.found = true;
      continue;
    }
    match.cell = cell;
    match.in_own_cell = search.own_cell(cell, p_local[i], match);
    if (match.in_own_cell) {
      match.found = true;
      match.nearest_known = false;
      match.clear_m = 0.0F;
    } else if (!still_nearest(p_local[i], query.max_distance_m, match)) {
      match.found = search.around(p_local[i], match);
    }
  }
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/nearest_plane.hpp"

#include <nanoflann.hpp>
#include <utility>

namespace isobar {

namespace {

// Adaptor that lets nanoflann read the planes of a tile.
struct PlanePoints {
  const std::vector<TileTree::Plane>& planes;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return planes.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return planes[index].q_tile[static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

// Result set for nanoflann: keeps the nearest plane that faces the viewpoint.
class NearestFacing {
 public:
  NearestFacing(const std::vector<TileTree::Plane>& planes, const Eigen::Vector3f& viewpoint_tile,
                float squared_distance)
      : planes_(planes), viewpoint_tile_(viewpoint_tile), worst_(squared_distance) {}

  bool addPoint(float squared_distance, std::uint32_t index) {  // NOLINT: nanoflann's name
    const TileTree::Plane& plane = planes_[index];
    if (squared_distance < worst_ && plane.normal.dot(viewpoint_tile_ - plane.q_tile) > 0.0F) {
      worst_ = squared_distance;
      plane_ = &plane;
    }
    return true;
  }
  [[nodiscard]] float worstDist() const { return worst_; }  // NOLINT: nanoflann's name
  [[nodiscard]] static bool full() { return true; }
  [[nodiscard]] const TileTree::Plane* plane() const { return plane_; }

 private:
  const std::vector<TileTree::Plane>& planes_;
  const Eigen::Vector3f& viewpoint_tile_;
  float worst_;
  const TileTree::Plane* plane_ = nullptr;
};

constexpr std::size_t kLeafSize = 10;  // planes per leaf of the k-d tree: nanoflann's default

std::vector<TileTree::Plane> planes_of(const PlaneTile& tile, float cell_m) {
  std::vector<TileTree::Plane> planes;
  planes.reserve(tile.plane_count);
  for (std::size_t i = 0; i < kBlocksPerTile; ++i) {
    if (tile.blocks[i] == nullptr) continue;
    const CellIndex from_corner = first_cell(tile.key, i) - first_cell(tile.key);
    const Eigen::Vector3f centre_tile = (from_corner.cast<float>().array() + 0.5F * kBlockCells) * cell_m;
    for (const PackedPlane& plane : tile.blocks[i]->planes) {
      planes.push_back({centre_tile + plane.q_block(cell_m), plane.unit_normal()});
    }
  }
  return planes;
}

std::size_t count_planes(const std::vector<std::shared_ptr<const TileTree>>& trees) {
  std::size_t count = 0;
  for (const auto& tree : trees) {
    count += tree->size();
  }
  return count;
}

}  // namespace

struct TileTree::Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PlanePoints>,
                                                    PlanePoints, 3, std::uint32_t>;
  explicit Tree(const std::vector<Plane>& planes)
      : points{planes}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}
  PlanePoints points;
  Index index;
};

TileTree::TileTree(const PlaneTile& tile, float cell_m)
    : key(tile.key), planes_(planes_of(tile, cell_m)), tree_(std::make_unique<Tree>(planes_)) {}

TileTree::~TileTree() = default;

const TileTree::Plane* TileTree::nearest(const Eigen::Vector3f& p_tile, const Eigen::Vector3f& viewpoint_tile,
                                         float& squared_distance) const {
  if (planes_.empty()) {
    return nullptr;
  }
  NearestFacing result(planes_, viewpoint_tile, squared_distance);
  tree_->index.findNeighbors(result, p_tile.data(), nanoflann::SearchParams());
  squared_distance = result.worstDist();
  return result.plane();
}

NearestPlane::NearestPlane(std::vector<std::shared_ptr<const TileTree>> trees, float cell_m,
                           std::uint32_t session)
    : MapSnapshot(cell_m, count_planes(trees), session), directory_(std::move(trees)) {}

bool NearestPlane::match_one(const MatchQuery& query, const Eigen::Vector3f& p_local,
                             PlaneMatch& match) const {
  const TileKey first = tile_of(query.frame.cell_of(p_local.array() - query.max_distance_m));
  const TileKey last = tile_of(query.frame.cell_of(p_local.array() + query.max_distance_m));
  float squared_distance = query.max_distance_m * query.max_distance_m;
  bool found = false;
  for (std::int32_t x = first.x; x <= last.x; ++x) {
    for (std::int32_t y = first.y; y <= last.y; ++y) {
      for (std::int32_t z = first.z; z <= last.z; ++z) {
        const TileTree* tree = directory_.find({x, y, z});
        if (tree == nullptr) continue;
        const Eigen::Vector3f corner = query.frame.corner_local(first_cell(tree->key));
        if (const TileTree::Plane* plane =
                tree->nearest(p_local - corner, query.viewpoint_local - corner, squared_distance)) {
          match.q_local = corner + plane->q_tile;
          match.normal = plane->normal;
          found = true;
        }
      }
    }
  }
  return found;
}

void NearestPlane::match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
                         std::span<PlaneMatch> matches) const {
  for (std::size_t i = 0; i < p_local.size(); ++i) {
    PlaneMatch& match = matches[i];
    match.found = match_one(query, p_local[i], match);
    match.in_own_cell = match.found && query.frame.cell_of(match.q_local) == query.frame.cell_of(p_local[i]);
  }
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/tile_index.hpp"

#include <nanoflann.hpp>
#include <utility>

namespace isobar {

namespace {

// The planes of a tile, as nanoflann wants to read them.
struct PlanePoints {
  const std::vector<TilePlane>& planes;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return planes.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return planes[index].q_tile[static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

// Keeps the nearest plane that faces the viewpoint.
class NearestFacing {
 public:
  NearestFacing(const std::vector<TilePlane>& planes, const Eigen::Vector3f& viewpoint_tile,
                float squared_distance)
      : planes_(planes), viewpoint_tile_(viewpoint_tile), worst_(squared_distance) {}

  bool addPoint(float squared_distance, std::uint32_t index) {  // NOLINT: nanoflann's name
    const TilePlane& plane = planes_[index];
    if (squared_distance < worst_ && plane.normal.dot(viewpoint_tile_ - plane.q_tile) > 0.0F) {
      worst_ = squared_distance;
      index_ = index;
    }
    return true;
  }
  [[nodiscard]] float worstDist() const { return worst_; }  // NOLINT: nanoflann's name
  [[nodiscard]] static bool full() { return true; }
  [[nodiscard]] std::ptrdiff_t index() const { return index_; }

 private:
  const std::vector<TilePlane>& planes_;
  const Eigen::Vector3f& viewpoint_tile_;
  float worst_;
  std::ptrdiff_t index_ = -1;
};

constexpr std::size_t kLeafSize = 10;

}  // namespace

struct TileIndex::Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PlanePoints>,
                                                    PlanePoints, 3, std::uint32_t>;
  explicit Tree(const std::vector<TilePlane>& planes)
      : points{planes}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}
  PlanePoints points;
  Index index;
};

TileIndex::TileIndex(const TileKey& key, std::vector<TilePlane> planes)
    : key_(key), planes_(std::move(planes)), tree_(std::make_unique<Tree>(planes_)) {}

TileIndex::~TileIndex() = default;

std::ptrdiff_t TileIndex::nearest(const Eigen::Vector3f& p_tile, const Eigen::Vector3f& viewpoint_tile,
                                  float& squared_distance) const {
  if (planes_.empty()) {
    return -1;
  }
  NearestFacing result(planes_, viewpoint_tile, squared_distance);
  tree_->index.findNeighbors(result, p_tile.data(), nanoflann::SearchParams());
  squared_distance = result.worstDist();
  return result.index();
}

}  // namespace isobar

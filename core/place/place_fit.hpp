// SPDX-License-Identifier: BSD-3-Clause
// How well a query fits a pose: walls where the map has walls, and rays only where it has none.
#pragma once

#include <Eigen/Geometry>
#include <numeric>
#include <vector>

#include "core/map/map_snapshot.hpp"
#include "core/place/correlative_search.hpp"
#include "core/place/place_query.hpp"
#include "core/place/slab_image.hpp"

namespace isobar {

/// All 0 … 1.
struct PlaceFit {
  double walls = 0.0;   ///< share of the query's wall points that lie on a wall of the map
  double others = 0.0;  ///< share of its other points that lie on a surface of the map
  double passed = 0.0;  ///< share of the query's free space that is inside of walls of the map

  /// 1: all fits. Free space inside of walls counts more: noise does not cause it, and furniture seldom.
  [[nodiscard]] double score() const { return walls - kPassedWeight * passed; }
  static constexpr double kPassedWeight = 3.0;
};

/// Fit by the cells of the slab, to about 0.2 m: for the choice of the hypotheses that are worth an ICP. 20 us.
[[nodiscard]] PlaceFit coarse_fit(const SlabImage& image, const PlaceQuery& query, const SlabPose& pose);

/// What speaks for a pose, item by item, so that two poses can be compared: each point by exp(-r^2 / 2 sigma^2) of its
/// distance r to a plane of the map, which is upright for points of walls, and each free cell by its weight, negative where it is inside of a
/// wall.
struct PlaceEvidence {
  std::vector<float> items;

  [[nodiscard]] double sum() const { return std::accumulate(items.begin(), items.end(), 0.0); }

  /// Standard deviations by which `better` fits better than `worse`, of the same query: the sum of the differences, relative
  /// to what differences of these sizes and of random sign would give. Neighbouring items are not independent.
  [[nodiscard]] static double lead(const PlaceEvidence& better, const PlaceEvidence& worse);
};

/// Fit by the planes of the map, to centimetres. `T_map_level`: heading and position of the levelled query.
/// `matches`: scratch.
[[nodiscard]] PlaceFit fine_fit(const MapSnapshot& map, const SlabImage& image, const PlaceQuery& query,
                                const Eigen::Isometry3d& T_map_level, std::vector<PlaneMatch>& matches,
                                PlaceEvidence& evidence);

/// Vertical offset [m], in steps of 0.1 m up to 0.5 m, at which most of the points that are no walls, ground and ceilings
/// mostly, lie on surfaces of the map; the least one of equals. `matches`: scratch.
[[nodiscard]] double vertical_offset_m(const MapSnapshot& map, const PlaceQuery& query,
                                       const Eigen::Isometry3d& T_map_level,
                                       std::vector<PlaneMatch>& matches);

}  // namespace isobar

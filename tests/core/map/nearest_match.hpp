// SPDX-License-Identifier: BSD-3-Clause
// Match of a single point, in coordinates of the map.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/map/map_snapshot.hpp"

namespace isobar::test {

struct NearestMatch {
  Eigen::Vector3d q_map;       ///< point on the plane [m]
  Eigen::Vector3f normal_map;  ///< unit normal towards the observer
};

/// Match of `p_map` with a plane as seen from `viewpoint_map`; nullopt without a match.
inline std::optional<NearestMatch> nearest_match(const MapSnapshot& map, const Eigen::Vector3d& p_map,
                                                 const Eigen::Vector3d& viewpoint_map,
                                                 double max_distance_m) {
  MatchQuery query;
  query.frame = LocalFrame(p_map, map.cell_m());
  query.viewpoint_local = query.frame.to_local(viewpoint_map);
  query.max_distance_m = static_cast<float>(max_distance_m);
  const Eigen::Vector3f p_local = query.frame.to_local(p_map);
  PlaneMatch match;
  map.match(query, {&p_local, 1}, {&match, 1});
  if (!match.found) return std::nullopt;
  return NearestMatch{query.frame.to_map(match.q_local), match.normal};
}

}  // namespace isobar::test

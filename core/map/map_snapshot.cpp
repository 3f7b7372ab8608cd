// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_snapshot.hpp"

namespace isobar {

void MapSnapshot::match(const MatchQuery& /*query*/, std::span<const Eigen::Vector3f> /*p_local*/,
                        std::span<PlaneMatch> matches) const {
  for (PlaneMatch& match : matches) {
    match.found = false;
  }
}

bool MapSnapshot::nearest(const Eigen::Vector3d& p_map, const Eigen::Vector3d& viewpoint_map,
                          double max_distance_m, MapMatch& result) const {
  MatchQuery query;
  query.frame = LocalFrame(p_map, cell_m_);
  query.viewpoint_local = query.frame.to_local(viewpoint_map);
  query.max_distance_m = static_cast<float>(max_distance_m);
  const Eigen::Vector3f p_local = query.frame.to_local(p_map);
  PlaneMatch found;
  match(query, {&p_local, 1}, {&found, 1});
  if (!found.found) {
    return false;
  }
  result.q_map = query.frame.to_map(found.q_local);
  result.normal_map = found.normal;
  result.distance_m = (found.q_local - p_local).norm();
  return true;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_snapshot.hpp"

namespace isobar {

void MapSnapshot::match(const MatchQuery& /*query*/, std::span<const Eigen::Vector3f> /*p_local*/,
                        std::span<PlaneMatch> matches) const {
  for (PlaneMatch& match : matches) {
    match.found = false;
  }
}
}  // namespace isobar

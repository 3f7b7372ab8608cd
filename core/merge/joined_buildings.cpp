// SPDX-License-Identifier: BSD-3-Clause
#include "core/merge/joined_buildings.hpp"

#include <algorithm>

#include "core/geometry.hpp"

namespace isobar {
namespace {

// Place of the first submap of B in the last one of A, 1 sigma.
constexpr double kLinkLevelM = 3.0;
constexpr double kLinkHeightM = 0.5;
constexpr double kLinkTiltRad = 0.1 * kRadPerDeg;
constexpr double kLinkYawRad = 5.0 * kRadPerDeg;
// Way between A and B, so that loops between them are looked for from the start.
constexpr double kWayBetweenM = 100.0;
// Time between A and B after which a bias of the altimeter is another one: some of its correlation times.
constexpr std::int64_t kTimeBetweenNs = 3'600'000'000'000;

std::int64_t last_stamp_ns(const StoredBuilding& building) {
  std::int64_t last_ns = building.submaps.back().stamp_ns;
  for (const Submap& submap : building.submaps) {
    if (!submap.keys.empty()) last_ns = std::max(last_ns, submap.keys.back().stamp_ns);
  }
  return last_ns;
}

ChainLink link_between(const Eigen::Isometry3d& T_last_first) {
  ChainLink link;
  link.T_before_submap = upright(T_last_first);
  Vector6d sigma;
  sigma << kLinkLevelM, kLinkLevelM, kLinkHeightM, kLinkTiltRad, kLinkTiltRad, kLinkYawRad;
  link.covariance = sigma.cwiseAbs2().asDiagonal();
  return link;
}

struct Shift {
  std::size_t submaps;
  double way_m;
  std::int64_t stamp_ns;
  double height_m;
};

void shift(Submap& submap, const Shift& by) {
  submap.number += static_cast<std::uint32_t>(by.submaps);
  submap.stamp_ns += by.stamp_ns;
  submap.first_way_m += by.way_m;
  submap.last_way_m += by.way_m;
  if (submap.air) submap.air->height_m += by.height_m;
  for (KeyScan& key : submap.keys) {
    key.stamp_ns += by.stamp_ns;
    key.way_m += by.way_m;
    if (key.air) key.air->height_m += by.height_m;
    key.scan = JoinedScans::of_b(key.scan);
  }
}

void shift(Loop& loop, const Shift& by) {
  loop.submap += by.submaps;
  loop.holder += by.submaps;
  loop.stamp_ns += by.stamp_ns;
  loop.way_m += by.way_m;
}

}  // namespace

JoinedBuildings join(const StoredBuilding& a, const Building& a_posed, const StoredBuilding& b,
                     const Building& b_posed, const JoiningPlace& place) {
  JoinedBuildings joined;
  joined.building.submaps = a.submaps;
  joined.building.loops = a.loops;
  joined.submaps_of_a = a.submaps.size();
  const std::int64_t least_ns = last_stamp_ns(a) + kTimeBetweenNs;
  joined.b_later_ns = std::max<std::int64_t>(least_ns - b.submaps.front().stamp_ns, 0);
  const Shift by{a.submaps.size(), a.submaps.back().last_way_m + kWayBetweenM - b.submaps.front().first_way_m,
                 joined.b_later_ns, place.air_z_a_b_m};
  for (Submap submap : b.submaps) {
    shift(submap, by);
    joined.building.submaps.push_back(std::move(submap));
  }
  for (Loop loop : b.loops) {
    shift(loop, by);
    joined.building.loops.push_back(loop);
  }
  joined.loops_of_each = joined.building.loops.size();
  const Eigen::Isometry3d T_a_first = place.T_a_b * b_posed.T_map_submap(0);
  joined.building.submaps[joined.submaps_of_a].link =
      link_between(a_posed.T_map_submap(joined.submaps_of_a - 1).inverse() * T_a_first);
  return joined;
}

}  // namespace isobar

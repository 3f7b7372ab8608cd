// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/ray_dispute.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <vector>

namespace isobar {

namespace {

// A point within this distance of a plane lies on it, 3 sigma of lidar, map and pose; beyond the other it does not.
constexpr float kOnSurfaceM = 0.06F;
constexpr float kOffSurfaceM = 0.15F;
constexpr float kSurfaceReachM = 0.35F;
// Errors of roll and pitch lift far ground and ceilings by this share of the range.
constexpr float kLiftedShare = 0.004F;
// A ray is compared with planes along it at these steps, and passes through those whose point is this near to it.
constexpr float kRayStepM = 0.15F;
constexpr float kCrossingM = 0.2F;
constexpr float kNearestCrossingM = 0.8F;
constexpr float kLeastCosine = 0.05F;
// Depth of the ray's end behind the plane.
constexpr float kLeastDepthM = 0.2F;
constexpr std::size_t kMostRays = 1000;
constexpr double kGroupM = 0.5;
constexpr int kLeastOfGroup = 3;
// Groups, and their extent, from which a pose is contradicted: one piece of furniture that has gone leaves fewer. At wrong
// poses of three-floors there were 15 … 43 groups, at right ones at most 1.
constexpr std::size_t kLeastGroups = 8;
constexpr float kLeastSpanM = 3.0F;
constexpr std::size_t kTimes = 8;
// Parts that the map has never seen speak for the wrong pose: at right ones up to a quarter of the disputed points.
constexpr std::size_t kTimesIfBlocked = 3;
// Share of all points that only one of the poses explains, above which the other is wrong without any blocked ray.
constexpr double kLargeShare = 0.2;

struct Pose {
  Pose(const MapSnapshot& map, const Eigen::Isometry3d& T_map_level)
      : query{LocalFrame(T_map_level.translation(), map.cell_m()), {}, kSurfaceReachM},
        T_local_level(T_map_level.cast<float>()) {
    T_local_level.translation() = query.frame.to_local(T_map_level.translation());
  }
  MatchQuery query;
  Eigen::Isometry3f T_local_level;
};

enum class OnSurface : std::uint8_t { kYes, kNo, kUncertain };

float lifted_m(const Eigen::Vector3f& normal, float range_m) {
  return std::abs(normal.z()) * kLiftedShare * range_m;
}

// Appends an entry a point of the scan.
void explain(const MapSnapshot& map, Pose& pose, const PlaceQuery::Scan& scan,
             std::vector<OnSurface>& found) {
  std::vector<Eigen::Vector3f> p_local(scan.p_level.begin(), scan.p_level.end());
  for (Eigen::Vector3f& p : p_local) p = pose.T_local_level * p;
  std::vector<PlaneMatch> matches(p_local.size());
  pose.query.viewpoint_local = pose.T_local_level * scan.p_level_lidar;
  pose.query.max_distance_m = kSurfaceReachM;
  map.match(pose.query, p_local, matches);
  for (std::size_t i = 0; i < p_local.size(); ++i) {
    const PlaneMatch& plane = matches[i];
    if (!plane.found) {
      found.push_back(OnSurface::kNo);
      continue;
    }
    const float lift_m = lifted_m(plane.normal, (p_local[i] - pose.query.viewpoint_local).norm());
    const float distance_m = std::abs(plane.normal.dot(p_local[i] - plane.q_local));
    found.push_back(distance_m < kOnSurfaceM + lift_m           ? OnSurface::kYes
                    : distance_m > kOffSurfaceM + 2.0F * lift_m ? OnSurface::kNo
                                                                : OnSurface::kUncertain);
  }
}

// A plane of the map that faces the lidar stands in the way of the ray.
bool is_blocked(const MapSnapshot& map, Pose& pose, const Eigen::Vector3f& p_level_lidar,
                const Eigen::Vector3f& p_level) {
  const Eigen::Vector3f eye = pose.T_local_level * p_level_lidar;
  const Eigen::Vector3f end = pose.T_local_level * p_level;
  const float range_m = (end - eye).norm();
  const Eigen::Vector3f unit = (end - eye) / range_m;
  std::vector<Eigen::Vector3f> steps;
  for (float along_m = kNearestCrossingM; along_m < range_m - kLeastDepthM; along_m += kRayStepM) {
    steps.emplace_back(eye + along_m * unit);
  }
  std::vector<PlaneMatch> matches(steps.size());
  pose.query.viewpoint_local = eye;
  pose.query.max_distance_m = kCrossingM + 0.5F * kRayStepM;
  map.match(pose.query, steps, matches);
  return std::any_of(matches.begin(), matches.end(), [&](const PlaneMatch& plane) {
    const float cosine = -plane.normal.dot(unit);
    if (!plane.found || cosine < kLeastCosine) return false;
    const Eigen::Vector3f crossing = eye + plane.normal.dot(eye - plane.q_local) / cosine * unit;
    const float depth_m = plane.normal.dot(plane.q_local - end);
    return (crossing - plane.q_local).norm() < kCrossingM &&
           depth_m > kLeastDepthM + 2.0F * lifted_m(plane.normal, range_m);
  });
}

using Groups = std::map<std::tuple<int, int, int>, int>;

void add_to_group(const Eigen::Vector3f& p, Groups& groups) {
  const auto cell = [](float c) { return static_cast<int>(std::floor(static_cast<double>(c) / kGroupM)); };
  ++groups[{cell(p.x()), cell(p.y()), cell(p.z())}];
}

void describe(const Groups& groups, RayDispute::Side& side) {
  Eigen::Array2f low = Eigen::Array2f::Constant(1e9F);
  Eigen::Array2f high = -low;
  for (const auto& [cell, count] : groups) {
    if (count < kLeastOfGroup) continue;
    ++side.blocked_groups;
    const Eigen::Array2f at(static_cast<float>(std::get<0>(cell)), static_cast<float>(std::get<1>(cell)));
    low = low.min(at);
    high = high.max(at);
  }
  if (side.blocked_groups > 0)
    side.blocked_span_m = static_cast<float>(kGroupM) * (high - low).matrix().norm();
}

struct DisputedRay {
  const PlaceQuery::Scan* scan;
  std::size_t index;
  bool only_one;  // pose `one` explains it
};

bool contradicts(const RayDispute::Side& right, const RayDispute::Side& wrong, std::size_t points) {
  const bool blocked = right.blocked_groups >= kLeastGroups && right.blocked_span_m >= kLeastSpanM &&
                       right.blocked_groups >= kTimes * wrong.blocked_groups;
  const bool many = static_cast<double>(right.explained) >= kLargeShare * static_cast<double>(points);
  return (blocked && right.explained >= kTimesIfBlocked * wrong.explained) ||
         (many && right.explained >= kTimes * wrong.explained);
}

}  // namespace

RayDispute::Winner RayDispute::winner() const {
  if (points == 0) return Winner::kNone;
  if (contradicts(one, other, points)) return Winner::kOne;
  return contradicts(other, one, points) ? Winner::kOther : Winner::kNone;
}

RayDispute dispute(const MapSnapshot& map, const PlaceQuery& query, const Eigen::Isometry3d& T_map_level_one,
                   const Eigen::Isometry3d& T_map_level_other) {
  Pose one(map, T_map_level_one);
  Pose other(map, T_map_level_other);
  RayDispute result;
  std::vector<DisputedRay> rays;
  std::vector<OnSurface> at_one;
  std::vector<OnSurface> at_other;
  const std::vector<PlaceQuery::Scan> scans = query.scans();
  for (const PlaceQuery::Scan& scan : scans) {
    at_one.clear();
    at_other.clear();
    explain(map, one, scan, at_one);
    explain(map, other, scan, at_other);
    result.points += scan.p_level.size();
    for (std::size_t i = 0; i < at_one.size(); ++i) {
      const bool only_one = at_one[i] == OnSurface::kYes && at_other[i] == OnSurface::kNo;
      const bool only_other = at_other[i] == OnSurface::kYes && at_one[i] == OnSurface::kNo;
      result.one.explained += only_one ? 1 : 0;
      result.other.explained += only_other ? 1 : 0;
      if (only_one || only_other) rays.push_back({&scan, i, only_one});
    }
  }
  Groups groups_one;
  Groups groups_other;
  const std::size_t step = rays.size() / kMostRays + 1;
  for (std::size_t k = 0; k < rays.size(); k += step) {
    const DisputedRay& ray = rays[k];
    const Eigen::Vector3f& p = ray.scan->p_level[ray.index];
    if (!is_blocked(map, ray.only_one ? other : one, ray.scan->p_level_lidar, p)) continue;
    add_to_group(p, ray.only_one ? groups_one : groups_other);
  }
  describe(groups_one, result.one);
  describe(groups_other, result.other);
  return result;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/place_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/place/place_grid.hpp"
#include "core/so3.hpp"

namespace isobar {

namespace {

// Distance of a point to its plane, 1 sigma: noise of the lidar, of the map, and of the mounts; roll and pitch of gravity.
constexpr float kSurfaceSigmaM = 0.05F;
constexpr float kTiltRad = 0.008F;
// The plane's point is at most this far away.
constexpr float kPlaneReachM = 0.4F;
constexpr float kUprightNormalZ = 0.5F;
// Items that depart together: points of one surface, cells of one opening.
constexpr double kCorrelatedItems = 3.0;
// Smaller differences are noise.
constexpr double kLeastDifference = 0.3;
// Items of a coarse fit.
constexpr std::size_t kCoarsePoints = 600;
constexpr std::size_t kCoarseStep = 4;

// Rigid motion seen from above, to cells of the image.
struct ToCells {
  ToCells(const SlabImage& image, const SlabPose& pose)
      : cosine(static_cast<float>(std::cos(pose.yaw_rad))),
        sine(static_cast<float>(std::sin(pose.yaw_rad))),
        x(static_cast<float>(pose.x_m / static_cast<double>(kPlaceCellM) - image.first_x())),
        y(static_cast<float>(pose.y_m / static_cast<double>(kPlaceCellM) - image.first_y())) {}
  [[nodiscard]] Eigen::Vector2i operator()(float px, float py) const {
    return {static_cast<int>(std::floor((cosine * px - sine * py) / kPlaceCellM + x)),
            static_cast<int>(std::floor((sine * px + cosine * py) / kPlaceCellM + y))};
  }
  float cosine;
  float sine;
  float x;
  float y;
};

std::uint16_t walls_around(const SlabImage& image, const Eigen::Vector2i& cell) {
  unsigned walls = 0;
  for (int row = cell.y() - 1; row <= cell.y() + 1; ++row) {
    for (int column = cell.x() - 1; column <= cell.x() + 1; ++column) walls |= image.walls_at(column, row);
  }
  return static_cast<std::uint16_t>(walls);
}

// Levels whose neighbours have a wall as well: the top of a railing may be a level lower than it seems.
unsigned within_walls(std::uint16_t walls) {
  const auto bits = static_cast<unsigned>(walls);
  return bits & bits << 1U & bits >> 1U;
}

// `evidence`: receives an item a free cell; may be null.
double passed_share(const SlabImage& image, const PlaceQuery& query, const SlabPose& pose, std::size_t step,
                    PlaceEvidence* evidence) {
  if (query.free_cells().empty()) return 0.0;
  const ToCells to_cells(image, pose);
  std::size_t passed = 0;
  const double per_cell =
      PlaceFit::kPassedWeight * double(query.wall_points().size()) / double(query.free_cells().size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < query.free_cells().size(); i += step) {
    const PlaceQuery::FreeCell& free = query.free_cells()[i];
    ++count;
    const Eigen::Vector2i cell = to_cells(free.p_level.x(), free.p_level.y());
    const bool inside = (within_walls(image.walls_at(cell.x(), cell.y())) & free.levels) != 0;
    passed += inside ? 1 : 0;
    if (evidence != nullptr) evidence->items.push_back(inside ? static_cast<float>(-per_cell) : 0.0F);
  }
  return double(passed) / double(count);
}

// Mean of the points' shares, which become items of the evidence. Errors of roll and pitch, which are common to all points,
// lift far ground and ceilings, but do not move walls sideways.
double add_shares(std::span<const Eigen::Vector3f> p_local, std::span<const PlaneMatch> matches, bool upright,
                  const Eigen::Vector3f& viewpoint_local, PlaceEvidence& evidence) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p_local.size(); ++i) {
    const PlaneMatch& plane = matches[i];
    float share = 0.0F;
    if (plane.found && (!upright || std::abs(plane.normal.z()) <= kUprightNormalZ)) {
      const float lifted_m = upright ? 0.0F : kTiltRad * (p_local[i] - viewpoint_local).norm();
      const float relative =
          plane.normal.dot(p_local[i] - plane.q_local) / std::hypot(kSurfaceSigmaM, lifted_m);
      share = std::exp(-0.5F * relative * relative);
    }
    evidence.items.push_back(share);
    sum += static_cast<double>(share);
  }
  return p_local.empty() ? 0.0 : sum / double(p_local.size());
}

}  // namespace

PlaceFit coarse_fit(const SlabImage& image, const PlaceQuery& query, const SlabPose& pose) {
  PlaceFit fit;
  if (query.wall_points().empty()) return fit;
  const ToCells to_cells(image, pose);
  const std::size_t step = query.wall_points().size() / kCoarsePoints + 1;
  std::size_t count = 0;
  std::size_t matched = 0;
  for (std::size_t i = 0; i < query.wall_points().size(); i += step) {
    const Eigen::Vector3f& p = query.wall_points()[i];
    ++count;
    const std::uint16_t walls = walls_around(image, to_cells(p.x(), p.y()));
    matched += (with_neighbours(height_bit(p.z())) & walls) != 0 ? 1 : 0;
  }
  fit.walls = double(matched) / double(count);
  fit.passed = passed_share(image, query, pose, kCoarseStep, nullptr);
  return fit;
}

double PlaceEvidence::lead(const PlaceEvidence& better, const PlaceEvidence& worse) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < std::min(better.items.size(), worse.items.size()); ++i) {
    const double difference = static_cast<double>(better.items[i] - worse.items[i]);
    if (std::abs(difference) < kLeastDifference) continue;
    sum += difference;
    squares += difference * difference;
  }
  return sum / std::sqrt(kCorrelatedItems * (squares + 1.0));
}

double vertical_offset_m(const MapSnapshot& map, const PlaceQuery& query,
                         const Eigen::Isometry3d& T_map_level, std::vector<PlaneMatch>& matches) {
  constexpr int kSteps = 5;
  constexpr double kStepM = 0.1;
  double best_m = 0.0;
  double best = 0.0;
  PlaceEvidence evidence;
  std::vector<Eigen::Vector3f> p_local;
  for (int i = 0; i <= 2 * kSteps; ++i) {
    const double offset_m = kStepM * (i % 2 == 0 ? -i / 2 : (i + 1) / 2);
    Eigen::Isometry3d T = T_map_level;
    T.translation().z() += offset_m;
    MatchQuery match{LocalFrame(T.translation(), map.cell_m()), {}, kPlaneReachM};
    Eigen::Isometry3f T_local_level = T.cast<float>();
    T_local_level.translation() = match.frame.to_local(T.translation());
    match.viewpoint_local = T_local_level * query.p_level_lidar();
    p_local.assign(query.other_points().begin(), query.other_points().end());
    for (Eigen::Vector3f& p : p_local) p = T_local_level * p;
    matches.assign(p_local.size(), {});
    map.match(match, p_local, matches);
    const double share = add_shares(p_local, matches, false, match.viewpoint_local, evidence);
    if (share <= best) continue;
    best = share;
    best_m = offset_m;
  }
  return best_m;
}

PlaceFit fine_fit(const MapSnapshot& map, const SlabImage& image, const PlaceQuery& query,
                  const Eigen::Isometry3d& T_map_level, std::vector<PlaneMatch>& matches,
                  PlaceEvidence& evidence) {
  PlaceFit fit;
  evidence.items.clear();
  MatchQuery match{LocalFrame(T_map_level.translation(), map.cell_m()), {}, kPlaneReachM};
  Eigen::Isometry3f T_local_level = T_map_level.cast<float>();
  T_local_level.translation() = match.frame.to_local(T_map_level.translation());
  match.viewpoint_local = T_local_level * query.p_level_lidar();
  std::vector<Eigen::Vector3f> p_local;
  const auto share_of = [&](std::span<const Eigen::Vector3f> p_level, bool upright) {
    p_local.assign(p_level.begin(), p_level.end());
    for (Eigen::Vector3f& p : p_local) p = T_local_level * p;
    matches.assign(p_local.size(), {});
    map.match(match, p_local, matches);
    return add_shares(p_local, matches, upright, match.viewpoint_local, evidence);
  };
  fit.walls = share_of(query.wall_points(), true);
  fit.others = share_of(query.other_points(), false);
  const SlabPose pose{T_map_level.translation().x(), T_map_level.translation().y(),
                      yaw_of(T_map_level.linear()), 0.0};
  fit.passed = passed_share(image, query, pose, 1, &evidence);
  return fit;
}

}  // namespace isobar

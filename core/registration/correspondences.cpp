// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/correspondences.hpp"

#include <algorithm>

namespace isobar {

namespace {
// Least share of the matched points with a plane of their own cell, so that they alone hold the pose.
constexpr double kLeastOwnShare = 0.25;
}  // namespace

Correspondences::Correspondences(std::size_t capacity)
    : p_robot_(capacity), p_local_(capacity), matches_(capacity) {
  pairs_.reserve(capacity);
}

void Correspondences::start(const MapSnapshot& map, const Eigen::Vector3d& p_map_base) {
  frame_ = LocalFrame(p_map_base, map.cell_m());
  stride_ = 0;
}

std::span<const Pair> Correspondences::find(const MapSnapshot& map, std::span<const Eigen::Vector3f> p_base,
                                            std::size_t stride, const Eigen::Isometry3d& T_map_base,
                                            const Eigen::Vector3d& p_base_lidar, double max_distance_m,
                                            PairChoice choice) {
  // Single precision: 10 um at 100 m.
  const Eigen::Matrix3f R_map_base = T_map_base.linear().cast<float>();
  const Eigen::Vector3f t_local = frame_.to_local(T_map_base.translation());
  std::size_t count = 0;
  for (std::size_t i = 0; i < p_base.size() && count < p_local_.size(); i += stride, ++count) {
    p_robot_[count] = R_map_base * p_base[i];
    p_local_[count] = t_local + p_robot_[count];
  }
  if (stride != stride_) keep_matches_of_common_points(stride, count);
  MatchQuery query;
  query.frame = frame_;
  query.viewpoint_local = frame_.to_local(T_map_base * p_base_lidar);
  query.max_distance_m = static_cast<float>(max_distance_m);
  map.match(query, {p_local_.data(), count}, {matches_.data(), count});

  collect_pairs(count, choice);
  return pairs_;
}

void Correspondences::collect_pairs(std::size_t count, PairChoice choice) {
  matched_ = 0;
  std::size_t own = 0;
  for (std::size_t i = 0; i < count; ++i) {
    matched_ += matches_[i].found ? 1 : 0;
    own += matches_[i].found && matches_[i].in_own_cell ? 1 : 0;
  }
  const bool all = choice == PairChoice::kNearest ||
                   static_cast<double>(own) < kLeastOwnShare * static_cast<double>(matched_);
  pairs_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const PlaneMatch& match = matches_[i];
    if (match.found && (all || match.in_own_cell)) {
      pairs_.push_back({p_robot_[i], match.normal, match.normal.dot(p_local_[i] - match.q_local)});
    }
  }
}

void Correspondences::keep_matches_of_common_points(std::size_t stride, std::size_t count) {
  const bool nested = stride_ != 0 && stride_ % stride == 0;
  const std::size_t ratio = nested ? stride_ / stride : 1;
  for (std::size_t i = count; i-- > 0;) {  // in place, backwards: reads lie before writes
    matches_[i] = nested && i % ratio == 0 ? matches_[i / ratio] : PlaneMatch{};
  }
  stride_ = stride;
}

}  // namespace isobar

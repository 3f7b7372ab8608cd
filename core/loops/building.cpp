// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/building.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Memory of a submap per plane, its blocks, tiles and the samples of its key scans included [bytes].
constexpr double kBytesPerPlane = 40.0;
// Submaps between two optimisations without a loop: the altimeter holds the height of the chain.
constexpr std::uint64_t kOptimiseEvery = 10;
// Turbulence and doors move the air's height for seconds [m].
constexpr double kLeastAirSigmaM = 0.05;
// Errors that a pair of loops may differ by, besides their own.
constexpr double kPairLevelM = 0.05;
constexpr double kPairHeightM = 0.03;
constexpr double kPairYawRad = 0.3 * kRadPerDeg;

}  // namespace

Building::Building(const LoopConfig& config, const MapConfig& map, const RegistrationConfig& registration,
                   const Eigen::Isometry3d& T_base_lidar)
    : most_planes_(static_cast<std::size_t>(config.memory_mb * 1e6 / kBytesPerPlane)),
      chain_({}, map, registration, T_base_lidar),
      matcher_({}, registration, SubmapConfig{}.sample_points, static_cast<float>(map.cell_m), T_base_lidar) {
}

bool Building::add(const RegisteredScan& scan, const std::optional<AirHeight>& air) {
  const ChainStep step = chain_.add(scan, air);
  if (!step.key) return false;
  ++counts_.key_scans;
  counts_.submaps = chain_.submaps().size();
  if (step.begins) {
    add_node(air);
    chain_.forget_beyond(most_planes_);
    if (counts_.submaps % kOptimiseEvery == 0) static_cast<void>(graph_.optimise());
  }
  return !chain_.last_key().p_base.empty() && look_for_loops(scan);
}

void Building::add_node(const std::optional<AirHeight>& air) {
  const std::size_t number = chain_.submaps().size() - 1;
  GraphNode node;
  node.stamp_ns = chain_.last_key().stamp_ns;
  node.T_map_submap = number == 0 ? upright(chain_.last_key().T_map_base)
                                  : T_map_submap(number - 1) * chain_.link(number).T_before_submap;
  const auto id = graph_.add_node(node);
  if (!id) return;
  if (number > 0) {
    const ChainLink& link = chain_.link(number);
    static_cast<void>(
        graph_.add_edge({*id - 1, *id, link.T_before_submap, link.covariance, EdgeKind::kOdometry}));
  }
  if (air) {
    static_cast<void>(graph_.add_altitude(
        {*id, air->height_m, std::max(kLeastAirSigmaM, std::sqrt(std::max(air->variance_m2, 0.0)))}));
  }
}

Eigen::Isometry3d Building::T_map_submap(std::size_t number) const {
  return graph_.T_map_submap(static_cast<NodeId>(number));
}

bool Building::look_for_loops(const RegisteredScan& scan) {
  const KeyScan& key = chain_.last_key();
  std::vector<Loop> accepted;
  bool scan_is_set = false;
  for (const Candidate& candidate : candidates(key)) {
    const auto expected = guess(candidate.submap, key);
    if (!expected) continue;
    if (!scan_is_set) matcher_.set_scan(scan);
    scan_is_set = true;
    ++counts_.tried;
    auto loop = matcher_.match(chain_.submaps()[candidate.submap], key, *expected);
    if (!loop) continue;
    ++counts_.matched;
    loop->holder = chain_.holder();
    const std::vector<Loop> pair = pairs_.add(evidence_of(*loop, *expected));
    accepted.insert(accepted.end(), pair.begin(), pair.end());
  }
  return !accepted.empty() && accept(accepted);
}

// Submaps of earlier visits with a key scan near this one, the nearest first.
std::vector<Building::Candidate> Building::candidates(const KeyScan& key) {
  std::vector<Candidate> found;
  const Eigen::Vector3d p_map = (T_map_submap(chain_.holder()) * key.T_submap_base).translation();
  for (std::size_t number = 0; number < chain_.complete(); ++number) {
    const Submap& submap = chain_.submaps()[number];
    if (!submap.planes || key.way_m - submap.last_way_m < search_.min_way_m) continue;
    const Eigen::Vector3d p_submap = T_map_submap(number).inverse() * p_map;
    double nearest_m = search_.max_distance_m + 1.0;
    for (const KeyScan& other : submap.keys) {
      const Eigen::Vector3d apart = other.T_submap_base.translation() - p_submap;
      if (std::abs(apart.z()) > search_.max_height_m) continue;
      nearest_m = std::min(nearest_m, apart.head<2>().norm());
    }
    if (nearest_m <= search_.max_distance_m) found.push_back({number, nearest_m});
  }
  std::sort(found.begin(), found.end(),
            [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  found.resize(std::min(found.size(), search_.candidates));
  return found;
}

std::optional<LoopGuess> Building::guess(std::size_t submap, const KeyScan& key) {
  LoopGuess guess;
  guess.T_submap_base = T_map_submap(submap).inverse() * T_map_submap(chain_.holder()) * key.T_submap_base;
  const auto covariance =
      graph_.relative_covariance(static_cast<NodeId>(submap), static_cast<NodeId>(chain_.holder()));
  if (!covariance) return std::nullopt;
  guess.level_sigma_m = std::sqrt(std::max((*covariance)(0, 0), (*covariance)(1, 1)));
  guess.height_sigma_m = std::sqrt((*covariance)(2, 2));
  guess.yaw_sigma_rad = std::sqrt((*covariance)(5, 5));
  if (search_.height_sigmas * guess.height_sigma_m > search_.max_height_m) return std::nullopt;
  return guess;
}

LoopEvidence Building::evidence_of(const Loop& loop, const LoopGuess& guess) const {
  LoopEvidence evidence;
  evidence.loop = loop;
  const Eigen::Matrix3d R_map_submap = T_map_submap(loop.submap).linear();
  evidence.shift.head<3>() =
      R_map_submap * (loop.T_submap_base.translation() - guess.T_submap_base.translation());
  evidence.shift(3) = yaw_of(loop.T_submap_base.linear() * guess.T_submap_base.linear().transpose());
  Eigen::Matrix<double, 4, 6> J = Eigen::Matrix<double, 4, 6>::Zero();
  J.topLeftCorner<3, 3>() = R_map_submap;
  J(3, 5) = 1.0;
  evidence.covariance = J * loop.covariance * J.transpose();
  evidence.covariance.diagonal() += Eigen::Vector4d(squared(kPairLevelM), squared(kPairLevelM),
                                                    squared(kPairHeightM), squared(kPairYawRad));
  return evidence;
}

bool Building::accept(const std::vector<Loop>& loops) {
  bool any = false;
  for (const Loop& loop : loops) {
    const bool added = graph_.add_edge({static_cast<NodeId>(loop.submap), static_cast<NodeId>(loop.holder),
                                        loop.T_submap_holder(), loop.holder_covariance(), EdgeKind::kLoop});
    if (!added) continue;
    any = true;
    ++counts_.accepted;
    loops_.push_back(loop);
  }
  if (!any) return false;
  const GraphResult result = graph_.optimise();
  counts_.taken = static_cast<std::uint64_t>(result.loops_taken);
  pairs_.clear();
  return true;
}

std::vector<CorrectedKey> Building::corrections() const {
  std::vector<CorrectedKey> corrections;
  if (counts_.taken == 0) return corrections;
  for (const Submap& submap : chain_.submaps()) {
    for (const KeyScan& key : submap.keys) {
      corrections.push_back({key.stamp_ns, key.T_map_base, T_map_submap(submap.number) * key.T_submap_base});
    }
  }
  return corrections;
}

}  // namespace isobar

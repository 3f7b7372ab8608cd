// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/building.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
// Place of a continued run in the building of the earlier one.
constexpr double kContinuedM = 0.2;
constexpr double kContinuedTiltRad = 0.1 * kRadPerDeg;
constexpr double kContinuedYawRad = 1.0 * kRadPerDeg;

}  // namespace

Building::Building(const LoopConfig& config, const MapConfig& map, const RegistrationConfig& registration,
                   const Eigen::Isometry3d& T_base_lidar, BuildingStorage* storage)
    : most_planes_(static_cast<std::size_t>(config.memory_mb * 1e6 / kBytesPerPlane)),
      storage_(storage),
      chain_({}, map, registration, T_base_lidar),
      matcher_({}, registration, SubmapConfig{}.sample_points, static_cast<float>(map.cell_m), T_base_lidar) {
}

void Building::continue_from(StoredBuilding stored) {
  moved_ns_ = std::move(stored.moved_ns);
  moves_before_ = moved_ns_.size();
  // The first loops tell the place in the submaps where the earlier run has ended.
  chain_.continue_from(std::move(stored.submaps), search_.min_way_m);
  counts_.submaps = chain_.submaps().size();
  for (const Submap& submap : chain_.submaps()) {
    counts_.key_scans += submap.keys.size();
    add_node(submap.number);
  }
  for (const Loop& loop : stored.loops) add_edge(loop);
  continued_ = counts_.submaps > 0;
  counts_.taken = static_cast<std::uint64_t>(graph_.optimise().loops_taken);
}

bool Building::add(const RegisteredScan& scan, const std::optional<AirHeight>& air) {
  follow_map(scan.pose);
  if (continued_) chain_.set_place(place_of(scan));
  const ChainStep step = chain_.add(scan, air);
  if (!step.key) return false;
  chain_.last_key().map_moves = static_cast<std::uint32_t>(moved_ns_.size());
  continued_ = false;
  ++counts_.key_scans;
  counts_.submaps = chain_.submaps().size();
  if (step.begins) add_node(chain_.submaps().size() - 1);
  store(scan, step.begins);
  if (step.begins) {
    chain_.forget_beyond(most_planes_);
    if (counts_.submaps % kOptimiseEvery == 0) static_cast<void>(graph_.optimise());
  }
  const KeyScan& key = chain_.last_key();
  return !key.p_base.empty() && look_for_loops({key, chain_.holder(), scan, chain_.complete()});
}

bool Building::look_again(std::size_t holder, std::size_t key, const RegisteredScan& scan,
                          std::size_t submaps) {
  KeyScan sampled = chain_.submaps()[holder].keys[key];
  take_sample(scan, SubmapConfig{}.sample_points, sampled.p_base);
  return look_for_loops({sampled, holder, scan, std::min(submaps, chain_.complete())});
}

void Building::follow_map(const PoseEstimate& pose) {
  if (!expected_move_ || moves_before_ + pose.map_moves <= moved_ns_.size()) return;
  chain_.follow_map(*expected_move_);
  expected_move_.reset();
  moved_ns_.push_back(pose.stamp_ns);
  if (storage_ != nullptr) storage_->add_move(pose.stamp_ns);
}

void Building::store(const RegisteredScan& scan, bool begins) {
  if (storage_ == nullptr) return;
  if (begins) storage_->add_submap(chain_.submaps().back());
  storage_->add_key(chain_.holder(), chain_.last_key(), scan);
}

// Where the robot goes on in the building of an earlier run: beside the key scan that is nearest in the live map, as the
// loops have moved it. Live map and building agree to decimetres; loops find the rest.
ChainLink Building::place_of(const RegisteredScan& scan) const {
  const Eigen::Isometry3d& T_map_base = scan.pose.T_map_base;
  double nearest_m = std::numeric_limits<double>::max();
  Eigen::Isometry3d T_map_corrected = T_map_base;
  for (const Submap& submap : chain_.submaps()) {
    for (const KeyScan& key : submap.keys) {
      const double distance_m = (key.T_map_base.translation() - T_map_base.translation()).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      T_map_corrected =
          T_map_submap(submap.number) * key.T_submap_base * key.T_map_base.inverse() * T_map_base;
    }
  }
  ChainLink place;
  place.T_before_submap = upright(T_map_submap(chain_.submaps().size() - 1).inverse() * T_map_corrected);
  Vector6d sigma;
  sigma << kContinuedM, kContinuedM, kContinuedM, kContinuedTiltRad, kContinuedTiltRad, kContinuedYawRad;
  place.covariance = sigma.cwiseAbs2().asDiagonal();
  return place;
}

void Building::add_node(std::size_t number) {
  const Submap& submap = chain_.submaps()[number];
  const std::optional<AirHeight>& air = submap.air;
  GraphNode node;
  node.stamp_ns = submap.stamp_ns;
  if (number > 0) {
    node.T_map_submap = T_map_submap(number - 1) * submap.link.T_before_submap;
  } else if (!submap.keys.empty()) {
    node.T_map_submap = upright(submap.keys.front().T_map_base);
  }
  const auto id = graph_.add_node(node);
  if (!id) return;
  if (number > 0) {
    const ChainLink& link = submap.link;
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

bool Building::look_for_loops(const Wanted& wanted) {
  std::vector<Loop> accepted;
  bool scan_is_set = false;
  for (const Candidate& candidate : candidates(wanted)) {
    const auto expected = guess(candidate.submap, wanted);
    if (!expected || !chain_.planes_of(candidate.submap, storage_)) continue;
    if (!scan_is_set) matcher_.set_scan(wanted.scan);
    scan_is_set = true;
    ++counts_.tried;
    auto loop = matcher_.match(chain_.submaps()[candidate.submap], wanted.key, *expected);
    if (!loop) continue;
    ++counts_.matched;
    loop->holder = wanted.holder;
    const std::vector<Loop> pair = pairs_.add(evidence_of(*loop, *expected));
    accepted.insert(accepted.end(), pair.begin(), pair.end());
  }
  return !accepted.empty() && accept(accepted);
}

// Submaps of earlier visits with a key scan near this one, the nearest first.
std::vector<Building::Candidate> Building::candidates(const Wanted& wanted) const {
  std::vector<Candidate> found;
  const KeyScan& key = wanted.key;
  const Eigen::Vector3d p_map = (T_map_submap(wanted.holder) * key.T_submap_base).translation();
  for (std::size_t number = 0; number < wanted.submaps; ++number) {
    const Submap& submap = chain_.submaps()[number];
    if ((!submap.planes && storage_ == nullptr) || key.way_m - submap.last_way_m < search_.min_way_m)
      continue;
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

std::optional<LoopGuess> Building::guess(std::size_t submap, const Wanted& wanted) {
  LoopGuess guess;
  guess.T_submap_base =
      T_map_submap(submap).inverse() * T_map_submap(wanted.holder) * wanted.key.T_submap_base;
  const auto covariance =
      graph_.relative_covariance(static_cast<NodeId>(submap), static_cast<NodeId>(wanted.holder));
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

bool Building::add_edge(const Loop& loop) {
  if (!graph_.add_edge({static_cast<NodeId>(loop.submap), static_cast<NodeId>(loop.holder),
                        loop.T_submap_holder(), loop.holder_covariance(), EdgeKind::kLoop})) {
    return false;
  }
  ++counts_.accepted;
  loops_.push_back(loop);
  return true;
}

bool Building::accept(const std::vector<Loop>& loops) {
  bool any = false;
  for (const Loop& loop : loops) {
    if (!add_edge(loop)) continue;
    any = true;
    if (storage_ != nullptr) storage_->add_loop(loop);
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
      corrections.push_back(
          {key.stamp_ns, key.T_map_base, T_map_submap(submap.number) * key.T_submap_base, key.map_moves});
    }
  }
  return corrections;
}

}  // namespace isobar

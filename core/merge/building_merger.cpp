// SPDX-License-Identifier: BSD-3-Clause
#include "core/merge/building_merger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Share of the work that the search of places takes.
constexpr double kSearchShare = 0.3;
// Error of a place that was found in the map: the ICP's, and that of the map's tiles against the submaps, 1 sigma.
constexpr double kSeedLevelM = 0.3;
constexpr double kSeedHeightM = 0.15;
constexpr double kSeedTiltRad = 0.1 * kRadPerDeg;
constexpr double kSeedYawRad = 1.0 * kRadPerDeg;
// Loops between both that agree: fewer are a chance.
constexpr std::size_t kLeastLoops = 3;
constexpr const char* kNoLoops = "its scans do not match the map where they should";

}  // namespace

BuildingMerger::BuildingMerger(const MergeSettings& settings, const MergeSide& a, const KnownMap& map_a,
                               const MergeSide& b, Progress progress)
    : settings_(settings),
      a_(a),
      map_a_(map_a),
      b_(b),
      progress_(std::move(progress)),
      scans_(a.scans, b.scans) {}

MergedBuilding BuildingMerger::run(const HeightRelation& height) {
  const std::unique_ptr<Building> a = posed(a_);
  const std::unique_ptr<Building> b = posed(b_);
  find_frame(*b, height);
  const FrameVerdict& frame = merged_.figures.frame;
  if (!frame.T_a_b) {
    merged_.problem = frame.agreeing.size() >= kLeastAgreeing ? "several places fit as well"
                                                              : "too few of its places agree on where it is";
    return std::move(merged_);
  }
  const bool tied = height.sigma_m < HeightRelation{}.sigma_m;
  merged_.joined = join(a_.building, *a, b_.building, *b,
                        {*frame.T_a_b, tied ? height.z_a_b_m : frame.T_a_b->translation().z()});
  find_loops(*a, *b, merged_.joined);
  if (merged_.figures.loops < kLeastLoops) {
    merged_.problem = kNoLoops;
    return std::move(merged_);
  }
  conclude(*b, merged_.joined);
  return std::move(merged_);
}

std::unique_ptr<Building> BuildingMerger::posed(const MergeSide& side) const {
  auto building =
      std::make_unique<Building>(settings_.loops, settings_.map, settings_.registration, side.T_base_lidar);
  building->continue_from(side.building);
  return building;
}

void BuildingMerger::find_frame(const Building& b, const HeightRelation& height) {
  PlaceFinder finder(map_a_, settings_.registration, b_.T_base_lidar, b_.scans);
  places_ = PlaceFinder::places_of(b);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    votes_.push_back(finder.look(b, places_[i], height));
    report(kSearchShare * static_cast<double>(i + 1) / static_cast<double>(places_.size()));
  }
  merged_.figures.searched = places_.size();
  merged_.figures.frame = common_frame(votes_);
}

std::size_t BuildingMerger::nearest_submap(const Building& a, const Eigen::Vector3d& p_a) const {
  double nearest_m = std::numeric_limits<double>::max();
  std::size_t nearest = 0;
  for (const Submap& submap : a.submaps()) {
    for (const KeyScan& key : submap.keys) {
      const Eigen::Vector3d p_key = a.T_map_submap(submap.number) * key.T_submap_base.translation();
      if ((p_key - p_a).norm() >= nearest_m) continue;
      nearest_m = (p_key - p_a).norm();
      nearest = submap.number;
    }
  }
  return nearest;
}

// A place found in the map as a loop, which says where loops are looked for.
Loop BuildingMerger::seed(const Building& a, const Building& b, const ChosenHypothesis& chosen) const {
  const PlaceFinder::KeyPlace& at = places_[chosen.vote];
  const KeyScan& key = b.submaps()[at.submap].keys[at.key];
  const Eigen::Isometry3d T_a_base =
      votes_[chosen.vote].hypotheses[chosen.hypothesis].T_a_b * b.T_map_submap(at.submap) * key.T_submap_base;
  Loop loop;
  loop.submap = nearest_submap(a, T_a_base.translation());
  loop.holder = a.submaps().size() + at.submap;
  loop.T_submap_base = a.T_map_submap(loop.submap).inverse() * T_a_base;
  loop.T_holder_base = key.T_submap_base;
  Vector6d sigma;
  sigma << kSeedLevelM, kSeedLevelM, kSeedHeightM, kSeedTiltRad, kSeedTiltRad, kSeedYawRad;
  loop.covariance = sigma.cwiseAbs2().asDiagonal();
  return loop;
}

// A building with the places that were found as loops guides the search; what it finds goes into `joined`.
void BuildingMerger::find_loops(const Building& a, const Building& b, JoinedBuildings& joined) {
  StoredBuilding guided = joined.building;
  for (const ChosenHypothesis& chosen : merged_.figures.frame.agreeing) {
    guided.loops.push_back(seed(a, b, chosen));
  }
  Building building(settings_.loops, settings_.map, settings_.registration, b_.T_base_lidar, &scans_);
  building.continue_from(std::move(guided));
  const std::size_t known = building.loops().size();
  const auto scan = std::make_unique<RegisteredScan>();
  double looked_way_m = -std::numeric_limits<double>::max();
  const std::vector<Submap>& submaps = building.submaps();
  for (std::size_t number = joined.submaps_of_a; number < submaps.size(); ++number) {
    for (std::size_t k = 0; k < submaps[number].keys.size(); ++k) {
      const KeyScan& key = submaps[number].keys[k];
      if (key.way_m - looked_way_m < SubmapConfig{}.loop_spacing_m) continue;
      if (key.scan == kNoScanHandle || !scans_.read_scan(key.scan, *scan)) continue;
      looked_way_m = key.way_m;
      static_cast<void>(building.look_again(number, k, *scan, joined.submaps_of_a));
    }
    report(kSearchShare + (1.0 - kSearchShare) * static_cast<double>(number + 1 - joined.submaps_of_a) /
                              static_cast<double>(submaps.size() - joined.submaps_of_a));
  }
  merged_.figures.tried = building.counts().tried;
  merged_.figures.matched = building.counts().matched;
  for (std::size_t i = known; i < building.loops().size(); ++i) {
    if (building.graph().loops()[i].weight <= 0.0) continue;
    joined.building.loops.push_back(building.loops()[i]);
    ++merged_.figures.loops;
  }
  const Eigen::Isometry3d T_a_first = building.T_map_submap(joined.submaps_of_a);
  ChainLink& link = joined.building.submaps[joined.submaps_of_a].link;
  link.T_before_submap = upright(building.T_map_submap(joined.submaps_of_a - 1).inverse() * T_a_first);
  merged_.figures.T_a_b = T_a_first * b.T_map_submap(0).inverse();
}

// Poses of the graph that is stored: without the places that were found as loops.
void BuildingMerger::conclude(const Building& b, JoinedBuildings& joined) {
  Building building(settings_.loops, settings_.map, settings_.registration, b_.T_base_lidar);
  building.continue_from(joined.building);
  for (Submap& submap : joined.building.submaps) {
    for (KeyScan& key : submap.keys) {
      key.T_map_base = building.T_map_submap(submap.number) * key.T_submap_base;
      key.map_moves = 0;
    }
  }
  double sum_m2 = 0.0;
  const std::size_t between = joined.building.loops.size() - joined.loops_of_each;
  merged_.figures.loops = 0;
  for (std::size_t i = building.loops().size() - between; i < building.loops().size(); ++i) {
    const Loop& loop = building.loops()[i];
    if (building.graph().loops()[i].weight <= 0.0) continue;
    const Eigen::Isometry3d T_submap_holder =
        building.T_map_submap(loop.submap).inverse() * building.T_map_submap(loop.holder);
    sum_m2 += (T_submap_holder.translation() - loop.T_submap_holder().translation()).squaredNorm();
    ++merged_.figures.loops;
  }
  if (merged_.figures.loops < kLeastLoops) merged_.problem = kNoLoops;
  merged_.figures.rms_m =
      std::sqrt(sum_m2 / static_cast<double>(std::max<std::size_t>(merged_.figures.loops, 1)));
  merged_.figures.T_a_b = building.T_map_submap(joined.submaps_of_a) * b.T_map_submap(0).inverse();
}

}  // namespace isobar

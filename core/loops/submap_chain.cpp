// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/submap_chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.hpp"
#include "core/loops/submap_maker.hpp"

namespace isobar {
namespace {

// Error of the live motion between two key scans, half a metre: the pull of a map that is known again included.
constexpr double kStepErrorM = 0.03;
constexpr double kStepErrorRad = 0.3 * kRadPerDeg;
// A result farther than this from the prediction is another wall [m].
constexpr double kLargestCorrectionM = 0.3;
constexpr double kLeastOverlap = 0.3;
// A step of this length that no registration confirms ends the submaps [m].
constexpr double kLongestUnconfirmedM = 1.5;
// Random walk of the chain with the way, 1 sigma.
constexpr double kLevelWalkMSqrtM = 0.008;
constexpr double kHeightWalkMSqrtM = 0.008;
constexpr double kYawWalkRadSqrtM = 0.03 * kRadPerDeg;
constexpr double kTiltRad = 0.1 * kRadPerDeg;

Vector6d walk_variance(double way_m) {
  Vector6d sigma;
  sigma << kLevelWalkMSqrtM, kLevelWalkMSqrtM, kHeightWalkMSqrtM, kTiltRad, kTiltRad, kYawWalkRadSqrtM;
  return sigma.cwiseAbs2() * way_m;
}

// Error of a step that only the live estimate knows: on a ride, behind a closed door, after a gap.
Vector6d unconfirmed_sigma(const Eigen::Vector3d& moved_m) {
  const double level_m = 0.02 + 0.05 * moved_m.head<2>().norm();
  const double height_m = 0.02 + 0.1 * std::abs(moved_m.z());
  constexpr double kYawRad = 0.5 * kRadPerDeg;
  Vector6d sigma;
  sigma << level_m, level_m, height_m, kTiltRad, kTiltRad, kYawRad;
  return sigma;
}

// Error of a robot that was lost and found again.
Vector6d lost_sigma() {
  Vector6d sigma;
  sigma << 2.0, 2.0, 0.3, kTiltRad, kTiltRad, 5.0 * kRadPerDeg;
  return sigma;
}

RegistrationConfig of_key_scans(RegistrationConfig config, std::size_t sample_points) {
  config.sample_points = sample_points;
  return config;
}

MapConfig with_radius(MapConfig config, double radius_m) {
  config.radius_m = std::min(config.radius_m, radius_m);
  return config;
}

}  // namespace

SubmapChain::SubmapChain(const SubmapConfig& config, const MapConfig& map,
                         const RegistrationConfig& registration, const Eigen::Isometry3d& T_base_lidar)
    : config_(config),
      map_config_(with_radius(map, config.radius_m)),
      T_base_lidar_(T_base_lidar),
      traits_(traits_of(Method::k4Dof, HeightSource::kNone)),
      matcher_(of_key_scans(registration, config.sample_points), T_base_lidar.translation()),
      moved_(std::make_unique<RegisteredScan>()) {}

ChainStep SubmapChain::add(const RegisteredScan& scan, const std::optional<AirHeight>& air) {
  ChainStep step;
  lost_ = lost_ || scan.pose.lost != LostReason::kNone;
  if (!choice_.wants(scan.pose)) return step;
  step.key = true;
  choice_.take(scan.pose);
  take_sample(scan, config_.sample_points, sample_);
  if (growing_.empty()) {
    begin_submap(scan, air);
    T_older_base_ = upright(scan.pose.T_map_base).inverse() * scan.pose.T_map_base;
    step.begins = true;
  } else {
    const bool coherent = take_step(scan);
    step.begins =
        !coherent || choice_.way_m() - submaps_[growing_.back().number].first_way_m >= config_.spacing_m;
    if (step.begins && growing_.size() == 2) complete_oldest();
    if (step.begins) begin_submap(scan, air);
    if (!coherent) complete_oldest();
  }
  T_map_live_ = scan.pose.T_map_base;
  hold(scan, air);
  insert(scan);
  return step;
}

// The older submap holds the key scan. Its sample serves the loops of this scan, and later the test of loops to this submap
// by free space.
void SubmapChain::hold(const RegisteredScan& scan, const std::optional<AirHeight>& air) {
  holder_ = growing_.front().number;
  Submap& holder = submaps_[holder_];
  holder.last_way_m = choice_.way_m();
  KeyScan key;
  key.stamp_ns = scan.pose.stamp_ns;
  key.way_m = choice_.way_m();
  key.T_map_base = scan.pose.T_map_base;
  key.T_submap_base = T_older_base_;
  key.air = air;
  if (choice_.way_m() - sampled_way_m_ >= config_.loop_spacing_m) {
    sampled_way_m_ = choice_.way_m();
    key.p_base = sample_;
  }
  holder.keys.push_back(std::move(key));
}

void SubmapChain::continue_from(std::vector<Submap> submaps, double gap_m) {
  submaps_ = std::move(submaps);
  complete_ = submaps_.size();
  used_.assign(submaps_.size(), 0);
  if (submaps_.empty()) return;
  holder_ = submaps_.size() - 1;
  sampled_way_m_ = submaps_.back().last_way_m + gap_m;
  choice_.begin_at(sampled_way_m_);
}

void SubmapChain::follow_map(const Eigen::Isometry3d& T_now_before) {
  choice_.follow_map(T_now_before);
  T_map_live_ = T_now_before * T_map_live_;
}

const std::shared_ptr<const MapSnapshot>& SubmapChain::planes_of(std::size_t number,
                                                                 BuildingStorage* storage) {
  used_[number] = ++uses_;
  Submap& submap = submaps_[number];
  if (!submap.planes && storage != nullptr) {
    SubmapMaker maker(map_config_, T_base_lidar_, *storage);
    submap.planes = maker.planes_of(submaps_, number);
    maker.restore_samples(submap, config_);
  }
  return submap.planes;
}

void SubmapChain::forget_beyond(std::size_t planes) {
  std::vector<std::size_t> kept;
  std::size_t sum = 0;
  for (std::size_t number = 0; number < complete_; ++number) {
    if (!submaps_[number].planes) continue;
    kept.push_back(number);
    sum += submaps_[number].planes->plane_count();
  }
  std::sort(kept.begin(), kept.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(used_[a], a) < std::pair(used_[b], b); });
  for (const std::size_t number : kept) {
    if (sum <= planes) break;
    sum -= submaps_[number].planes->plane_count();
    submaps_[number].planes.reset();
    for (KeyScan& key : submaps_[number].keys) key.p_base = {};
  }
}

// The live motion since the last key scan; its attitude as it is.
Eigen::Isometry3d SubmapChain::predicted(const RegisteredScan& scan) const {
  const Eigen::Isometry3d T_upright = upright(T_map_live_);
  const Eigen::Isometry3d T_older_upright = upright(T_older_base_);
  return T_older_upright * (T_upright.inverse() * scan.pose.T_map_base);
}

// The live map is larger and has all scans: where it holds nothing of an earlier visit, no motion is better known.
bool SubmapChain::on_new_ground(const RegisteredScan& scan) {
  const bool was_known = std::exchange(known_ground_, scan.pose.on_known_ground);
  return !was_known && !known_ground_ && scan.pose.mode == PoseMode::kRegistered;
}

// Registers the key scan to the older submap. What no registration confirms is as uncertain as the live motion; a submap
// is rigid, hence false, for the end of both growing submaps, where that is too much to be held by one.
bool SubmapChain::take_step(const RegisteredScan& scan) {
  const Eigen::Isometry3d expected = predicted(scan);
  const Eigen::Vector3d moved_m = expected.translation() - T_older_base_.translation();
  variance_ += walk_variance(moved_m.norm());
  T_older_base_ = expected;
  const bool lost = std::exchange(lost_, false);
  if (lost) variance_ += lost_sigma().cwiseAbs2();
  if (on_new_ground(scan)) return !lost;
  const LocalMap& older = *growing_.front().map;
  MatchResult result;
  if (!older.snapshot()->empty()) {
    Prediction prediction;
    prediction.T_map_base = expected;
    prediction.deviation << kStepErrorRad, kStepErrorRad, kStepErrorRad, kStepErrorM, kStepErrorM,
        kStepErrorM;
    result = matcher_.match({*older.snapshot(), sample_, traits_, prediction, 0.0});
  }
  const double correction_m = (result.T_map_base.translation() - expected.translation()).norm();
  if (result.solved && result.overlap >= kLeastOverlap && correction_m < kLargestCorrectionM) {
    T_older_base_ = result.T_map_base;
    return !lost;
  }
  variance_ += unconfirmed_sigma(moved_m).cwiseAbs2();
  return !lost && moved_m.norm() < kLongestUnconfirmedM;
}

void SubmapChain::begin_submap(const RegisteredScan& scan, const std::optional<AirHeight>& air) {
  Submap submap;
  submap.number = static_cast<std::uint32_t>(submaps_.size());
  submap.stamp_ns = scan.pose.stamp_ns;
  submap.air = air;
  submap.first_way_m = submap.last_way_m = choice_.way_m();
  if (growing_.empty() && !submaps_.empty()) {
    submap.link = place_;
  } else if (!submaps_.empty()) {
    submap.link = {upright(T_older_base_), variance_.asDiagonal()};
  }
  variance_.setZero();
  used_.push_back(++uses_);
  growing_.push_back({submaps_.size(), std::make_unique<LocalMap>(map_config_, T_base_lidar_)});
  submaps_.push_back(std::move(submap));
}

// The pose of the last key scan goes over to the younger one.
void SubmapChain::complete_oldest() {
  if (growing_.size() > 1) {
    T_older_base_ = submaps_[growing_[1].number].link.T_before_submap.inverse() * T_older_base_;
  }
  submaps_[growing_.front().number].planes = growing_.front().map->snapshot();
  growing_.erase(growing_.begin());
  complete_ = submaps_.size() - growing_.size();
}

void SubmapChain::insert(const RegisteredScan& scan) {
  moved_->pose = scan.pose;
  moved_->pose.session = 1;
  moved_->pose.map_moves = 0;
  moved_->point_count = scan.point_count;
  std::copy_n(scan.points, scan.point_count, moved_->points);
  for (std::size_t i = 0; i < growing_.size(); ++i) {
    const Eigen::Isometry3d T_submap_older =
        i == 0 ? Eigen::Isometry3d::Identity() : submaps_[growing_[i].number].link.T_before_submap.inverse();
    moved_->pose.T_map_base = T_submap_older * T_older_base_;
    growing_[i].map->update(*moved_);
  }
}

}  // namespace isobar

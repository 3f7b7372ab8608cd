// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/submap_chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.hpp"

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
  take_sample(scan);
  if (growing_.empty()) {
    T_older_base_ = upright(scan.pose.T_map_base).inverse() * scan.pose.T_map_base;
    begin_submap();
    step.begins = true;
  } else {
    const bool coherent = take_step(scan);
    step.begins =
        !coherent || choice_.way_m() - submaps_[growing_.back().number].first_way_m >= config_.spacing_m;
    if (step.begins && growing_.size() == 2) complete_oldest();
    if (step.begins) begin_submap();
    if (!coherent) complete_oldest();
  }
  T_map_live_ = scan.pose.T_map_base;
  holder_ = growing_.front().number;
  Submap& holder = submaps_[holder_];
  holder.last_way_m = choice_.way_m();
  holder.keys.push_back({scan.pose.stamp_ns, choice_.way_m(), scan.pose.T_map_base, T_older_base_, air, {}});
  if (choice_.way_m() - sampled_way_m_ >= config_.loop_spacing_m) {
    sampled_way_m_ = choice_.way_m();
    holder.keys.back().p_base = sample_;
  }
  insert(scan);
  return step;
}

void SubmapChain::forget_beyond(std::size_t planes) {
  std::size_t first_kept = complete_;
  for (std::size_t sum = 0; first_kept > forgotten_; --first_kept) {
    sum += submaps_[first_kept - 1].planes->plane_count();
    if (sum > planes) break;
  }
  for (; forgotten_ < first_kept; ++forgotten_) {
    submaps_[forgotten_].planes.reset();
    for (KeyScan& key : submaps_[forgotten_].keys) key.p_base = {};
  }
}

// The live motion since the last key scan; its attitude as it is.
Eigen::Isometry3d SubmapChain::predicted(const RegisteredScan& scan) const {
  const Eigen::Isometry3d T_upright = upright(T_map_live_);
  const Eigen::Isometry3d T_older_upright = upright(T_older_base_);
  return T_older_upright * (T_upright.inverse() * scan.pose.T_map_base);
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

void SubmapChain::begin_submap() {
  Submap submap;
  submap.number = static_cast<std::uint32_t>(submaps_.size());
  submap.first_way_m = choice_.way_m();
  ChainLink link;
  if (!submaps_.empty()) link = {upright(T_older_base_), variance_.asDiagonal()};
  variance_.setZero();
  links_.push_back(link);
  growing_.push_back({submaps_.size(), std::make_unique<LocalMap>(map_config_, T_base_lidar_)});
  submaps_.push_back(std::move(submap));
}

// The pose of the last key scan goes over to the younger one.
void SubmapChain::complete_oldest() {
  if (growing_.size() > 1) {
    T_older_base_ = links_[growing_[1].number].T_before_submap.inverse() * T_older_base_;
  }
  submaps_[growing_.front().number].planes = growing_.front().map->snapshot();
  growing_.erase(growing_.begin());
  complete_ = submaps_.size() - growing_.size();
}

void SubmapChain::insert(const RegisteredScan& scan) {
  moved_->pose = scan.pose;
  moved_->pose.session = 1;
  moved_->point_count = scan.point_count;
  std::copy_n(scan.points, scan.point_count, moved_->points);
  for (std::size_t i = 0; i < growing_.size(); ++i) {
    const Eigen::Isometry3d T_submap_older =
        i == 0 ? Eigen::Isometry3d::Identity() : links_[growing_[i].number].T_before_submap.inverse();
    moved_->pose.T_map_base = T_submap_older * T_older_base_;
    growing_[i].map->update(*moved_);
  }
}

void SubmapChain::take_sample(const RegisteredScan& scan) {
  sample_.clear();
  const std::size_t stride = scan.point_count / config_.sample_points + 1;
  for (std::size_t i = 0; i < scan.point_count; i += stride) {
    sample_.emplace_back(scan.points[i].x_m, scan.points[i].y_m, scan.points[i].z_m);
  }
}

}  // namespace isobar

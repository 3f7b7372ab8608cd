// SPDX-License-Identifier: BSD-3-Clause
// Coarse to fine: which points take part in an iteration of the ICP, and how far they search.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/geometry.hpp"
#include "core/registration/correspondences.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/twist.hpp"

namespace isobar {

/// At most two coarse iterations over every third point, then fine ones over all points; meanwhile the search
/// distance halves down to RegistrationConfig::last_distance_m. Only a fine iteration at that distance ends
/// the registration. Once a step was small, only planes of the points' own cells count.
class SearchSchedule {
 public:
  /// `prior_error_m`: twice the standard deviation of the prediction in the free directions; widens the first
  /// search, by kLargestSearchM at most.
  SearchSchedule(const RegistrationConfig& config, double prior_error_m)
      : config_(config), distance_m_(config.first_distance_m + std::min(prior_error_m, kLargestSearchM)) {}

  /// Every stride()-th point takes part.
  [[nodiscard]] std::size_t stride() const { return fine() ? 1 : kCoarseStride; }
  /// Share of the points that take part, 0 … 1.
  [[nodiscard]] double share() const { return fine() ? 1.0 : 1.0 / kCoarseStride; }
  /// Largest distance of a correspondence [m].
  [[nodiscard]] double distance_m() const { return distance_m_; }

  /// True once a fine step was small: what follows refines the pose.
  [[nodiscard]] bool settled() const { return settled_; }
  /// Which planes count.
  [[nodiscard]] PairChoice choice() const { return settled_ ? PairChoice::kOwnCell : PairChoice::kNearest; }

  /// True where the step just taken ends the registration: fine, at the last distance, and small.
  [[nodiscard]] bool converged(const Vector6d& step) const {
    return settled_ && below(step, config_.convergence_m, config_.convergence_deg * kRadPerDeg);
  }

  /// Chooses the next iteration after `step`.
  void advance(const Vector6d& step) {
    if (!fine()) coarse_left_ = below(step, kSmallStepM, kSmallStepRad) ? 0 : coarse_left_ - 1;
    settled_ = fine() && step.tail<3>().norm() < kSmallStepM;
    distance_m_ =
        settled_ ? config_.last_distance_m : std::max(config_.last_distance_m, distance_m_ * kDistanceShrink);
  }

 private:
  // The first iterations need a coarse result only: a third of the points suffices.
  static constexpr int kCoarseIterations = 2;
  static constexpr std::size_t kCoarseStride = 3;
  // A coarse step smaller than this needs no second one.
  static constexpr double kSmallStepM = 0.02;
  static constexpr double kSmallStepRad = 0.3 * kRadPerDeg;
  static constexpr double kDistanceShrink = 0.5;
  // Wider than this a search finds the wrong wall more often than the right one.
  static constexpr double kLargestSearchM = 2.0;

  [[nodiscard]] bool fine() const { return coarse_left_ == 0; }
  [[nodiscard]] static bool below(const Vector6d& step, double limit_m, double limit_rad) {
    return step.tail<3>().norm() < limit_m && step.head<3>().norm() < limit_rad;
  }

  RegistrationConfig config_;
  double distance_m_;
  int coarse_left_ = kCoarseIterations;
  bool settled_ = false;  // fine, at the last distance, after a small step
};

}  // namespace isobar

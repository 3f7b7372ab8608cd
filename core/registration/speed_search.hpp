// SPDX-License-Identifier: BSD-3-Clause
// The speed of a robot without wheels whose run begins in motion.
//
// Rings of a lidar on the ground and on walls along the way fit a map of one scan at any speed, and best at none: they
// move with the lidar. What stands across the way fits at the true speed only, and ICP does not find it from afar.
// Laid onto each other as if the robot stood, the first scans make a map in which it stands for good. So the scans after
// the first are matched to it from a set of velocities; the one at which planes across the way hold the pose counts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/registration/scan_matcher.hpp"

namespace isobar {

/// Hypotheses of a constant velocity from the first scan on. Allocates nothing.
class SpeedSearch {
 public:
  /// Speeds that are tried [m/s], in kDirections directions. ICP bridges 1.5 m/s: 15 cm a scan.
  static constexpr std::array<double, 5> kSpeedsMS{3.0, 6.0, 9.0, 12.0, 15.0};
  static constexpr std::size_t kDirections = 8;
  static constexpr std::size_t kHypotheses = 1 + kSpeedsMS.size() * kDirections;
  /// Most scans after the first that are looked at.
  static constexpr int kScans = 4;

  SpeedSearch() { restart(); }
  void restart();

  [[nodiscard]] bool done() const { return done_; }
  /// Horizontal velocity of a hypothesis, axes of the map [m/s]. 0: the robot stands.
  [[nodiscard]] const Eigen::Vector2d& velocity_m_s(std::size_t hypothesis) const {
    return hypotheses_[hypothesis].v_map_m_s;
  }
  /// A scan `after_s` after the first has been matched from that velocity, and lies `moved_m` away from the first.
  void add(std::size_t hypothesis, const MatchResult& match, const Eigen::Vector2d& moved_m, double after_s);
  /// All hypotheses have seen the scan: ends the search where they tell a speed, or that the robot stands.
  void end_scan();
  /// Another source tells the speed.
  void stop() { done_ = true; }
  /// The velocity that fits best, zero where none fits clearly better than to stand.
  [[nodiscard]] const Eigen::Vector2d& best_m_s() const { return velocity_m_s(best()); }

 private:
  struct Hypothesis {
    Eigen::Vector2d v_map_m_s = Eigen::Vector2d::Zero();
    double fit = 0.0;
  };
  [[nodiscard]] std::size_t best() const;

  std::array<Hypothesis, kHypotheses> hypotheses_;
  int scans_ = 0;
  bool done_ = false;
};

}  // namespace isobar

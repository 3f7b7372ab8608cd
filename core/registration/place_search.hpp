// SPDX-License-Identifier: BSD-3-Clause
// Confirmation of the place by the first scans of a run that continues in a known map.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/registration/known_place.hpp"
#include "core/registration/motion_model.hpp"
#include "core/registration/scan_matcher.hpp"

namespace isobar {

/// State of the search.
enum class PlaceVerdict : std::uint8_t {
  kSearching,
  kFound,      ///< apply correction(); the next scans confirm it
  kConfirmed,  ///< some scans in a row match the map there
  kUnknown,    ///< no hypothesis matches: the robot is elsewhere
};

/// The robot stands where it was last, or near: it drove on before this process was ready, it was pushed, or
/// it was turned on the spot. Hypotheses of the pose around the last one, the nearest first, are matched a
/// few a scan; the first that leaves no doubt, else the best of all, must then be confirmed by
/// kConfirmingScans scans in a row. Allocates in begin() only.
class PlaceSearch {
 public:
  /// Hypotheses to be matched with one scan: bounds the time of a scan.
  static constexpr std::size_t kPerScan = 4;

  /// Begins the search around `place`. `now_ns`: time of the first prior, robot clock.
  void begin(const KnownPlace& place, std::int64_t now_ns);
  void stop() {
    active_ = false;
    hypotheses_.clear();
  }
  [[nodiscard]] bool active() const { return active_; }
  /// A correction was found, and scans are confirming it.
  [[nodiscard]] bool confirming() const { return found_; }

  /// The next hypothesis, as a prediction near `expected`, for one match.
  [[nodiscard]] Prediction next(const Prediction& expected);
  /// Result of the match of the last next().
  void judge(const Prediction& expected, const MatchResult& result);
  /// To be called after the matches of a scan.
  PlaceVerdict end_of_scan();
  /// Result of the match of one scan at the found place, instead of next() and judge().
  PlaceVerdict confirm(const MatchResult& result);

  /// Rigid motion in the map from the expected to the found pose.
  [[nodiscard]] const Eigen::Isometry3d& correction() const { return best_correction_; }
  /// The match is that of the right place.
  [[nodiscard]] bool fits(const MatchResult& result) const;
  /// `expected` with the errors of a robot that has just been found.
  [[nodiscard]] static Prediction near(const Prediction& expected);

  /// Where the robot is at `now_ns` if it kept its velocity; the last place after a longer pause.
  [[nodiscard]] static Eigen::Isometry3d expected_pose(const KnownPlace& place, std::int64_t now_ns);

 private:
  struct Hypothesis {
    double x_m = 0.0;
    double y_m = 0.0;
    double yaw_rad = 0.0;
  };

  void restart_round();

  std::vector<Hypothesis> hypotheses_;
  double least_overlap_ = 0.0;
  double certain_overlap_ = 1.0;
  double largest_residual_m_ = 0.0;
  std::size_t next_ = 0;
  double best_overlap_ = 0.0;
  Eigen::Isometry3d best_correction_ = Eigen::Isometry3d::Identity();
  int rounds_ = 0;
  int confirmations_ = 0;
  int refusals_ = 0;
  bool active_ = false;
  bool found_ = false;
};

}  // namespace isobar

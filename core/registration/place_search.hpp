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
#include "core/registration/unseen_motion.hpp"

namespace isobar {

/// State of the search.
enum class PlaceVerdict : std::uint8_t {
  kSearching,
  kFound,      ///< apply correction(); the next scans confirm it
  kConfirmed,  ///< some scans in a row match the map there
  kUnknown,    ///< no hypothesis matches: the robot is elsewhere
  kUnseen,  ///< no hypothesis matches, but the robot stood: it is where it was, and its surroundings are new
};

/// Where a search around a hint looks, and what a match must show.
struct HintedPlace {
  double radius_m = 1.0;        ///< hypotheses of the position lie within it
  double turn_rad = 0.5;        ///< those of the yaw within this, and half a spacing
  double sigma_m = 0.5;         ///< of the position, 1 sigma
  double overlap = 0.0;         ///< of the last scans that matched the map; 0: unknown
  double residual_rms_m = 0.0;  ///< the same
  bool has_height = false;      ///< the height is known
};

/// The robot stands where it was last, or near: it drove on before this process was ready, it was pushed, or
/// it was turned on the spot. Hypotheses of the pose around the expected one, the nearest first, are matched a few a
/// scan. Of the matches that fit, the one with the largest posterior is taken: the share of the scan that matches,
/// times the density of the expected pose, which decides where the scans cannot, as along a bare corridor or on a
/// flight of equal steps. kConfirmingScans scans in a row must then confirm it. Allocates in its constructor only.
class PlaceSearch {
 public:
  PlaceSearch() { hypotheses_.reserve(kMostHypotheses); }

  /// Most hypotheses of a search: 81 places within 5 m, 12 headings.
  static constexpr std::size_t kMostHypotheses = 1024;
  /// Hypotheses to be matched with one scan: the expected pose and its neighbours. Bounds the time of a scan.
  static constexpr std::size_t kPerScan = 9;

  /// Begins the search for a robot that was at `place`, `pause_s` ago, around `expected`.
  void begin(const KnownPlace& place, double pause_s, const ExpectedPlace& expected);
  /// Begins a search around a place that somebody names: one round.
  void begin_around(const HintedPlace& place);
  void stop() {
    active_ = false;
    hypotheses_.clear();
  }
  [[nodiscard]] bool active() const { return active_; }
  /// A correction was found, and scans are confirming it.
  [[nodiscard]] bool confirming() const { return found_; }
  /// False for a scan with too few points to judge by: the first revolution may be incomplete.
  [[nodiscard]] static bool can_judge(std::size_t sampled_points);

  /// The next hypothesis, as a prediction near `expected`, for one match.
  [[nodiscard]] Prediction next(const Prediction& expected);
  /// Result of the match of the last next().
  void judge(const Prediction& expected, const MatchResult& result);
  /// To be called after the matches of a scan.
  PlaceVerdict end_of_scan();
  /// Result of the match of one scan at the found place, instead of next() and judge().
  PlaceVerdict confirm(const Prediction& expected, const MatchResult& result);

  /// Rigid motion in the map from the expected to the found pose.
  [[nodiscard]] const Eigen::Isometry3d& correction() const { return best_correction_; }
  /// The match is that of the right place.
  [[nodiscard]] bool fits(const Prediction& expected, const MatchResult& result) const;
  /// `expected` with the errors of a robot that has just been found.
  [[nodiscard]] static Prediction near(const Prediction& expected);

 private:
  struct Hypothesis {
    double x_m = 0.0;
    double y_m = 0.0;
    double yaw_rad = 0.0;
    std::size_t number = 0;  ///< decides between equals
  };

  [[nodiscard]] PlaceVerdict end_of_round();
  void add_hypotheses(double along_m, double track_rad);
  void add(double x_m, double y_m, double yaw_rad);
  void sort_hypotheses();
  void set_limits(const KnownPlace& place, bool short_pause, double unseen_m);
  void restart_round();
  [[nodiscard]] double expectation(const Prediction& expected, const MatchResult& result) const;

  std::vector<Hypothesis> hypotheses_;
  double least_overlap_ = 0.0;
  double largest_residual_m_ = 0.0;
  std::size_t next_ = 0;
  double known_overlap_ = 1.0;     // at the last place
  double expected_error_m_ = 1.0;  // of the expected place, 1 sigma
  double best_score_ = 0.0;        // 0: no match has fitted
  Eigen::Isometry3d best_correction_ = Eigen::Isometry3d::Identity();
  int rounds_ = 0;
  int confirmations_ = 0;
  int refusals_ = 0;
  bool active_ = false;
  bool found_ = false;
  bool stood_ = false;
  bool has_height_ = false;
};

}  // namespace isobar

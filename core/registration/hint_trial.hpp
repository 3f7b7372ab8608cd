// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "core/estimates.hpp"
#include "core/registration/place_hint.hpp"
#include "core/registration/place_search.hpp"

namespace isobar {

/// The trial of a hint: hypotheses around it, which move on with the robot by dead reckoning, are matched to the map
/// beside whatever else the registration does, a few a scan, until one is confirmed or all are refused. Allocates in its
/// constructor only.
class HintTrial {
 public:
  /// Takes a hint, instead of one that waits or is tried.
  void offer(const PlaceHint& hint);
  /// The hint that waits for its first scan; null: none.
  [[nodiscard]] const PlaceHint* waiting() const { return offered_ ? &*offered_ : nullptr; }

  /// Begins the trial of the waiting hint.
  /// @param T_map_base pose that it means at the time of `now`
  /// @param overlap,residual_rms_m of the scans that matched before; 0: unknown
  void begin(const Prior& now, const Eigen::Isometry3d& T_map_base, double overlap, double residual_rms_m);
  /// Ends the trial, or refuses the waiting hint.
  void finish(HintOutcome outcome, std::int64_t stamp_ns);
  void set_distance(double distance_m) { report_.distance_m = distance_m; }

  [[nodiscard]] bool active() const { return search_.active(); }
  /// Too long without an outcome: scans are missing, or cannot be judged.
  [[nodiscard]] bool is_overdue(std::int64_t now_ns) const;
  /// Where the hint means at the time of `now`. Requires active(), as all below.
  [[nodiscard]] Eigen::Isometry3d expected(const Prior& now) const;
  /// A scan has shown that the place is at `T_map_base` at the time of `now`.
  void move_to(const Prior& now, const Eigen::Isometry3d& T_map_base);
  /// The map has been moved.
  void follow_map(const Eigen::Isometry3d& T_now_before) { T_map_base_ = T_now_before * T_map_base_; }
  [[nodiscard]] PlaceSearch& search() { return search_; }

  /// A registered scan: a sudden fall of its overlap may be the moment in which somebody carried the robot away. From the
  /// next scan on it matches there as well, because it is in the map.
  /// @param usual_overlap of the scans before, smoothed; 0: unknown
  void watch(std::int64_t stamp_ns, double overlap, double usual_overlap);
  /// The robot may have been carried away lately.
  [[nodiscard]] bool present_is_doubtful(std::int64_t now_ns) const;

  [[nodiscard]] const HintReport& report() const { return report_; }
  /// Times that the robot went on from a hint.
  [[nodiscard]] std::uint32_t relocations() const { return relocations_; }

 private:
  std::optional<PlaceHint> offered_;
  PlaceSearch search_;
  Eigen::Isometry3d T_map_base_ = Eigen::Isometry3d::Identity();   // at the anchor
  Eigen::Isometry3d T_odom_base_ = Eigen::Isometry3d::Identity();  // there
  bool has_height_ = false;
  double height_m_ = 0.0;  // of the prior, there
  std::int64_t began_ns_ = 0;
  std::int64_t fell_ns_ = 0;  // last sudden fall of the overlap; 0: none
  std::uint32_t relocations_ = 0;
  HintReport report_;
};

}  // namespace isobar

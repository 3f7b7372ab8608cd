// SPDX-License-Identifier: BSD-3-Clause
// Where a tracked robot drives and how fast: turns a list of waypoints into raw poses.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// A point to pass. Heights may differ only between waypoints of one straight line (a flight or a ramp).
struct Waypoint {
  Eigen::Vector2d xy_m;
  double z_m = 0.0;
  double speed_m_s = 0.6;      ///< wanted speed on the way to this point
  std::string label = "flat";  ///< segment label of the way to this point
};

/// A stretch of time with one label.
struct LabelledSpan {
  double start_s = 0.0;
  double end_s = 0.0;
  std::string label;
};

/// Limits of the platform. A tracked robot of the paper's size (Clearpath Husky-like, 0.9 m long).
struct PlatformLimits {
  double acceleration_m_s2 = 0.5;
  double turn_rate_rad_s = 0.6;
  double corner_radius_m = 0.65;
  double bend_radius_m = 6.0;     ///< of bends too slight to slow down for
  double convex_blend_m = 0.20;   ///< half length over which it tips over an upper edge
  double concave_blend_m = 0.45;  ///< half length over which it rides out of a lower edge: half the tracks
};

/// Appends motion after motion; every one begins where the last ended.
class Route {
 public:
  Route(const Eigen::Vector2d& xy_m, double z_m, double yaw_rad, PlatformLimits limits = {});

  void wait(double seconds);
  /// Turns towards the first waypoint if need be and drives through all of them, rounding corners; comes to
  /// rest at the last.
  void drive(const std::vector<Waypoint>& waypoints);
  /// Turns on the spot.
  void turn(double angle_rad);
  /// Is carried vertically by height_m: jerk-limited, at most speed_m_s.
  void ride(double height_m, double speed_m_s, double acceleration_m_s2);

  [[nodiscard]] double time_s() const;
  [[nodiscard]] const std::vector<RawPose>& samples() const { return samples_; }
  [[nodiscard]] const std::vector<LabelledSpan>& labels() const { return labels_; }
  [[nodiscard]] const RawPose& pose() const { return samples_.back(); }

 private:
  void add(const RawPose& pose, const std::string& label);

  PlatformLimits limits_;
  std::vector<RawPose> samples_;
  std::vector<LabelledSpan> labels_;
};

/// Rms of the small motions at full strength, from 0.4 m/s on. Defaults: tracks on hard floor.
struct ShakeSizes {
  double roll_deg = 0.15;
  double pitch_deg = 0.15;
  double yaw_deg = 0.4;
  double heave_m = 0.001;
};

/// The small motions of tracks on a floor and of tracks rattling over step edges: adds band-limited roll,
/// pitch, yaw and height to the raw poses, growing with speed and larger on stairs.
void add_shaking(std::vector<RawPose>& samples, const std::vector<LabelledSpan>& labels, Random random,
                 const ShakeSizes& on_flat = {});

}  // namespace isobar::simulation

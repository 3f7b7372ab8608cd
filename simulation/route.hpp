// SPDX-License-Identifier: BSD-3-Clause
// Motion of a robot: turns waypoints, turns and rides into raw poses.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// A point of a route. Heights may differ only between waypoints on one straight line (a flight of stairs or
/// a ramp).
struct Waypoint {
  Eigen::Vector2d xy_m;
  double z_m = 0.0;
  double speed_m_s = 0.6;      ///< target speed from the previous waypoint to this one
  std::string label = "flat";  ///< segment label from the previous waypoint to this one
};

/// Time span with one label.
struct LabelledSpan {
  double start_s = 0.0;
  double end_s = 0.0;
  std::string label;
};

/// Motion limits of the platform. Defaults: a tracked robot of the paper's size (like a Clearpath Husky, 0.9
/// m long).
struct PlatformLimits {
  double acceleration_m_s2 = 0.5;
  double turn_rate_rad_s = 0.6;
  double corner_radius_m = 0.65;
  double bend_radius_m = 6.0;    ///< radius of bends below 0.3 rad, driven at full speed
  double convex_blend_m = 0.20;  ///< half length of the pitch change where the slope decreases (upper edge)
  double concave_blend_m =
      0.45;  ///< the same where the slope increases (lower edge): half of the tracks' length
};

/// Sequence of motions, each of which begins where the last one ended.
class Route {
 public:
  Route(const Eigen::Vector2d& xy_m, double z_m, double yaw_rad, PlatformLimits limits = {});

  void wait(double seconds);
  /// Turns towards the first waypoint if necessary, drives through all of them with rounded corners, and
  /// stops at the last.
  /// @throws std::logic_error when two waypoints are too close for the arc between them
  void drive(const std::vector<Waypoint>& waypoints);
  /// Turns on the spot.
  void turn(double angle_rad);
  /// Vertical motion in an elevator by `height_m`: jerk-limited, at most `speed_m_s`.
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

/// Rms of the vibrations at 0.4 m/s and above. Defaults: tracks on a hard floor.
struct ShakeSizes {
  double roll_deg = 0.15;
  double pitch_deg = 0.15;
  double yaw_deg = 0.4;
  double heave_m = 0.001;
};

/// Adds band-limited vibrations of roll, pitch, yaw and height to raw poses: growing with speed, and larger
/// on stairs, where tracks roll over the edges of the steps.
void add_shaking(std::vector<RawPose>& samples, const std::vector<LabelledSpan>& labels, Random random,
                 const ShakeSizes& on_flat = {});

}  // namespace isobar::simulation

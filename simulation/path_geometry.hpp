// SPDX-License-Identifier: BSD-3-Clause
// Path through a list of waypoints as a function of the distance s along it.
#pragma once

#include <string>
#include <vector>

#include "simulation/route.hpp"

namespace isobar::simulation {

/// In plan, straight lines joined by arcs; in elevation, straight slopes joined by parabolas.
class PathGeometry {
 public:
  /// @throws std::logic_error when two waypoints are too close for the arc between them
  PathGeometry(const std::vector<Waypoint>& waypoints, double start_yaw_rad, const PlatformLimits& limits);

  [[nodiscard]] double length_m() const { return pieces_.back().end_s; }
  /// Position, heading (unwrapped, continuous from the start) and pitch at `s`, measured in plan [m].
  [[nodiscard]] RawPose pose(double s) const;
  /// Target speed at `s`: the minimum over the next half metre.
  [[nodiscard]] double speed_m_s(double s) const;
  [[nodiscard]] const std::string& label(double s) const;

 private:
  /// A straight line (curvature 0) or an arc.
  struct Piece {
    double start_s = 0.0;
    double end_s = 0.0;
    Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
    double yaw_rad = 0.0;
    double curvature_1_m = 0.0;  ///< positive to the left
  };
  struct Leg {
    double end_s = 0.0;
    double speed_m_s = 0.0;
    std::string label;
  };

  void add_piece(const Eigen::Vector2d& start, double yaw, double curvature, double length);
  [[nodiscard]] const Piece& piece(double s) const;
  [[nodiscard]] const Leg& leg(double s) const;
  [[nodiscard]] double slope_after(std::size_t knot) const;
  [[nodiscard]] double blend_m(std::size_t knot) const;

  PlatformLimits limits_;
  std::vector<Piece> pieces_;
  std::vector<Leg> legs_;
  std::vector<Eigen::Vector2d> heights_;  ///< knots (s, z)
};

}  // namespace isobar::simulation

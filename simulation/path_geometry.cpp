// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/path_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

double wrap(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

Vector2d heading(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

}  // namespace

PathGeometry::PathGeometry(const std::vector<Waypoint>& waypoints, double start_yaw_rad,
                           const PlatformLimits& limits)
    : limits_(limits) {
  double yaw = start_yaw_rad;
  Vector2d at = waypoints.front().xy_m;
  heights_.push_back({0.0, waypoints.front().z_m});
  double s = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Vector2d target = waypoints[i].xy_m;
    const Vector2d way = target - at;
    yaw += wrap(std::atan2(way.y(), way.x()) - yaw);
    double turn = 0.0;
    if (i + 1 < waypoints.size()) {
      const Vector2d next = waypoints[i + 1].xy_m - target;
      turn = wrap(std::atan2(next.y(), next.x()) - yaw);
    }
    // Slight bends have a wide arc, which needs no lower speed.
    const double radius = std::abs(turn) < 0.3 ? limits.bend_radius_m : limits.corner_radius_m;
    const double tangent = radius * std::tan(0.5 * std::abs(turn));
    const double straight = way.norm() - tangent;
    if (straight < -1e-9) throw std::logic_error("waypoints are too close for the corner between them");
    add_piece(at, yaw, 0.0, straight);
    s += straight;
    at += straight * heading(yaw);
    const double arc = std::abs(turn) < 1e-6 ? 0.0 : radius * std::abs(turn);
    heights_.push_back({s + 0.5 * arc, waypoints[i].z_m});
    legs_.push_back({s + 0.5 * arc, waypoints[i].speed_m_s, waypoints[i].label});
    if (arc > 0.0) {
      const double curvature = std::copysign(1.0 / radius, turn);
      add_piece(at, yaw, curvature, arc);
      s += arc;
      yaw += turn;
      at = target + tangent * heading(yaw);
    }
  }
}

void PathGeometry::add_piece(const Vector2d& start, double yaw, double curvature, double length) {
  const double from = pieces_.empty() ? 0.0 : pieces_.back().end_s;
  pieces_.push_back({from, from + length, start, yaw, curvature});
}

const PathGeometry::Piece& PathGeometry::piece(double s) const {
  const auto found =
      std::find_if(pieces_.begin(), pieces_.end(), [s](const Piece& p) { return s <= p.end_s; });
  return found == pieces_.end() ? pieces_.back() : *found;
}

const PathGeometry::Leg& PathGeometry::leg(double s) const {
  const auto found = std::find_if(legs_.begin(), legs_.end(), [s](const Leg& l) { return s <= l.end_s; });
  return found == legs_.end() ? legs_.back() : *found;
}

double PathGeometry::slope_after(std::size_t knot) const {
  if (knot + 1 >= heights_.size()) return 0.0;
  const Vector2d step = heights_[knot + 1] - heights_[knot];
  return step.x() > 1e-9 ? step.y() / step.x() : 0.0;
}

double PathGeometry::blend_m(std::size_t knot) const {
  const double before = knot == 0 ? 0.0 : slope_after(knot - 1);
  return slope_after(knot) > before ? limits_.concave_blend_m : limits_.convex_blend_m;
}

RawPose PathGeometry::pose(double s) const {
  const Piece& on = piece(s);
  const double d = s - on.start_s;
  RawPose pose;
  pose.yaw_rad = on.yaw_rad + on.curvature_1_m * d;
  Vector2d xy = on.start_m + d * heading(on.yaw_rad);
  if (on.curvature_1_m != 0.0) {
    const double r = 1.0 / on.curvature_1_m;
    xy = on.start_m + r * Vector2d(std::sin(pose.yaw_rad) - std::sin(on.yaw_rad),
                                   std::cos(on.yaw_rad) - std::cos(pose.yaw_rad));
  }
  pose.x_m = xy.x();
  pose.y_m = xy.y();

  // Piecewise linear height, plus a parabola across each knot within its blending length.
  std::size_t knot = 0;
  while (knot + 2 < heights_.size() && s > heights_[knot + 1].x()) ++knot;
  double slope = slope_after(knot);
  pose.z_m = heights_[knot].y() + slope * (s - heights_[knot].x());
  for (std::size_t near = knot; near <= knot + 1 && near < heights_.size(); ++near) {
    if (near == 0 || near + 1 == heights_.size()) continue;
    const double h = blend_m(near);
    const double offset = s - heights_[near].x();
    if (std::abs(offset) >= h) continue;
    const double change = slope_after(near) - slope_after(near - 1);
    const double inside = h - std::abs(offset);
    pose.z_m += change * inside * inside / (4.0 * h);
    slope += (offset < 0.0 ? 1.0 : -1.0) * change * inside / (2.0 * h);
  }
  pose.pitch_rad = -std::atan(slope);
  return pose;
}

double PathGeometry::speed_m_s(double s) const {
  double speed = leg(s).speed_m_s;
  for (const double ahead : {0.0, 0.15, 0.3, 0.5}) {
    const double at = std::min(s + ahead, length_m());
    const double curvature = std::abs(piece(at).curvature_1_m);
    speed = std::min(speed, leg(at).speed_m_s);
    if (curvature > 0.0) speed = std::min(speed, limits_.turn_rate_rad_s / curvature);
  }
  return speed;
}

const std::string& PathGeometry::label(double s) const { return leg(s).label; }

}  // namespace isobar::simulation

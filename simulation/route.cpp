// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/path_geometry.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

/// Height of an elevator ride at `time_s`: symmetric speed profile with ramps v = V (1 - cos(pi t / ramp)) /
/// 2, whose jerk is finite.
double ride_height(double time_s, double ramp_s, double cruise_s, double speed_m_s) {
  const auto ramp = [&](double t) {  // integral of the ramp from 0 to t
    const double w = std::numbers::pi / ramp_s;
    return 0.5 * speed_m_s * (t - std::sin(w * t) / w);
  };
  const double total_s = 2.0 * ramp_s + cruise_s;
  const double t = std::clamp(time_s, 0.0, total_s);
  if (t <= ramp_s) return ramp(t);
  const double top = ramp(ramp_s);
  if (t <= ramp_s + cruise_s) return top + speed_m_s * (t - ramp_s);
  return 2.0 * top + speed_m_s * cruise_s - ramp(total_s - t);
}

}  // namespace

Route::Route(const Vector2d& xy_m, double z_m, double yaw_rad, PlatformLimits limits) : limits_(limits) {
  add({xy_m.x(), xy_m.y(), z_m, yaw_rad, 0.0, 0.0}, "flat");
}

double Route::time_s() const { return SplineGrid::kStepS * static_cast<double>(samples_.size() - 1); }

void Route::add(const RawPose& pose, const std::string& label) {
  samples_.push_back(pose);
  if (labels_.empty() || labels_.back().label != label) labels_.push_back({time_s(), time_s(), label});
  labels_.back().end_s = time_s();
}

void Route::wait(double seconds) {
  const RawPose still = pose();
  const std::string label = labels_.back().label;
  for (double t = SplineGrid::kStepS; t < seconds; t += SplineGrid::kStepS) add(still, label);
}

void Route::turn(double angle_rad) {
  const RawPose start = pose();
  // Angle along half a cosine, so that the peak of the turn rate is the limit.
  const double duration_s = std::abs(angle_rad) * std::numbers::pi / (2.0 * limits_.turn_rate_rad_s);
  for (double t = SplineGrid::kStepS; t < duration_s + SplineGrid::kStepS; t += SplineGrid::kStepS) {
    RawPose next = start;
    next.yaw_rad += angle_rad * 0.5 * (1.0 - std::cos(std::numbers::pi * std::min(1.0, t / duration_s)));
    add(next, labels_.back().label);
  }
}

void Route::ride(double height_m, double speed_m_s, double acceleration_m_s2) {
  const RawPose start = pose();
  const double distance = std::abs(height_m);
  // The peak acceleration of the cosine ramp is pi V / (2 ramp).
  double speed = speed_m_s;
  double ramp_s = std::numbers::pi * speed / (2.0 * acceleration_m_s2);
  if (speed * ramp_s > distance) {
    speed = std::sqrt(2.0 * acceleration_m_s2 * distance / std::numbers::pi);
    ramp_s = distance / speed;
  }
  const double cruise_s = (distance - speed * ramp_s) / speed;
  const double total_s = 2.0 * ramp_s + cruise_s;
  for (double t = SplineGrid::kStepS; t < total_s + SplineGrid::kStepS; t += SplineGrid::kStepS) {
    RawPose next = start;
    next.z_m += std::copysign(ride_height(t, ramp_s, cruise_s, speed), height_m);
    add(next, "elevator");
  }
}

void Route::drive(const std::vector<Waypoint>& waypoints) {
  std::vector<Waypoint> all{{{pose().x_m, pose().y_m}, pose().z_m, 0.6, "flat"}};
  for (const Waypoint& waypoint : waypoints) {
    if ((waypoint.xy_m - all.back().xy_m).norm() > 1e-6) all.push_back(waypoint);
  }
  if (all.size() < 2) return;
  const Vector2d first = all[1].xy_m - all[0].xy_m;
  const double turn_rad =
      std::remainder(std::atan2(first.y(), first.x()) - pose().yaw_rad, 2.0 * std::numbers::pi);
  if (std::abs(turn_rad) > 1e-6) turn(turn_rad);
  const PathGeometry path(all, pose().yaw_rad, limits_);
  double s = 0.0;
  double v = 0.0;
  while (path.length_m() - s > 1e-3) {
    const double a = limits_.acceleration_m_s2;
    const double wanted = std::min(path.speed_m_s(s), std::sqrt(2.0 * a * (path.length_m() - s)));
    v = std::max(0.01, v + std::clamp(wanted - v, -1.5 * a * SplineGrid::kStepS, a * SplineGrid::kStepS));
    s = std::min(path.length_m(), s + v * SplineGrid::kStepS);
    add(path.pose(s), path.label(s));
  }
}

void add_shaking(std::vector<RawPose>& samples, const std::vector<LabelledSpan>& labels, Random random,
                 const ShakeSizes& on_flat) {
  // Sizes: tracked robots on hard floor roll and pitch by a few tenths of a degree, on steps by about a
  // degree at the frequency of the steps (attitude logs of the paper's platform; Okada et al. 2010).
  constexpr double kDegree = std::numbers::pi / 180.0;
  constexpr ShakeSizes kOnStairs{0.8, 1.0, 0.8, 0.006};
  GaussMarkov roll(1.0, 0.25, Random(random.next()));
  GaussMarkov pitch(1.0, 0.25, Random(random.next()));
  GaussMarkov yaw(1.0, 0.6, Random(random.next()));
  GaussMarkov heave(1.0, 0.15, Random(random.next()));
  std::size_t span = 0;
  double strength = 0.0;
  Vector2d before(samples.front().x_m, samples.front().y_m);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = SplineGrid::kStepS * static_cast<double>(i);
    while (span + 1 < labels.size() && t > labels[span].end_s) ++span;
    RawPose& pose = samples[i];
    const Vector2d here(pose.x_m, pose.y_m);
    const double speed = (here - before).norm() / SplineGrid::kStepS;
    before = here;
    strength += 0.25 * (std::min(1.0, speed / 0.4) - strength);  // fades in and out over 0.2 s
    const bool stairs = labels[span].label == "stairs" && std::abs(pose.pitch_rad) > 0.1;
    const ShakeSizes& sizes = stairs ? kOnStairs : on_flat;
    pose.roll_rad += strength * roll.step(SplineGrid::kStepS) * sizes.roll_deg * kDegree;
    pose.pitch_rad += strength * pitch.step(SplineGrid::kStepS) * sizes.pitch_deg * kDegree;
    pose.yaw_rad += strength * yaw.step(SplineGrid::kStepS) * sizes.yaw_deg * kDegree;
    pose.z_m += strength * heave.step(SplineGrid::kStepS) * sizes.heave_m;
  }
}

}  // namespace isobar::simulation

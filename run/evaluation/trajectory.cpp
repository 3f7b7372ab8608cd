// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/errors.hpp"
#include "run/text/tum_row.hpp"

namespace isobar::evaluation {

namespace {

constexpr double kNsPerS = 1e9;
}  // namespace

double Trajectory::duration_s() const {
  if (poses.size() < 2) return 0.0;
  return static_cast<double>(poses.back().stamp_ns - poses.front().stamp_ns) / kNsPerS;
}

Trajectory make_trajectory(std::vector<StampedPose> poses) {
  Trajectory trajectory;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].stamp_ns < poses[i - 1].stamp_ns) ++trajectory.repairs.backwards;
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp_ns < b.stamp_ns; });
  const auto last = std::unique(poses.begin(), poses.end(), [](const StampedPose& a, const StampedPose& b) {
    return a.stamp_ns == b.stamp_ns;
  });
  trajectory.repairs.duplicates = static_cast<std::size_t>(poses.end() - last);
  poses.erase(last, poses.end());
  trajectory.poses = std::move(poses);
  return trajectory;
}

Trajectory parse_tum(std::string_view text, const std::string& name) {
  std::vector<StampedPose> poses;
  text::TextLines lines(text, name);
  std::size_t cut_line = 0;
  try {
    while (const auto row = text::next_tum_row(lines)) {
      poses.push_back({row->stamp_ns, row->position_m, row->attitude});
    }
  } catch (const DataError&) {
    if (!lines.without_end() || poses.empty()) throw;
    cut_line = lines.line_number();
  }
  if (poses.empty()) {
    throw DataError(name + ": has no pose");
  }
  Trajectory trajectory = make_trajectory(std::move(poses));
  trajectory.repairs.cut_line = cut_line;
  return trajectory;
}

std::vector<double> travelled_distance_m(const std::vector<StampedPose>& poses, double min_step_m) {
  std::vector<double> distance_m(poses.size(), 0.0);  // first the raw length of the path, including noise
  for (std::size_t i = 1; i < poses.size(); ++i) {
    distance_m[i] = distance_m[i - 1] + (poses[i].position_m - poses[i - 1].position_m).norm();
  }
  double travelled_m = 0.0;
  double raw_at_anchor_m = 0.0;
  std::size_t anchor = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double step_m = (poses[i].position_m - poses[anchor].position_m).norm();
    if (step_m < min_step_m && i + 1 < poses.size()) continue;
    const double raw_step_m = distance_m[i] - raw_at_anchor_m;
    raw_at_anchor_m = distance_m[i];
    const double scale = raw_step_m > 0.0 ? step_m / raw_step_m : 0.0;
    for (std::size_t j = i; j > anchor; --j) {
      distance_m[j] = travelled_m + step_m - scale * (raw_at_anchor_m - distance_m[j]);
    }
    travelled_m += step_m;
    anchor = i;
  }
  return distance_m;
}

double yaw_rad(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

double wrap_angle_rad(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

}  // namespace isobar::evaluation

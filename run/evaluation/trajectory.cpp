// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/errors.hpp"
#include "run/evaluation/text_table.hpp"

namespace isobar::evaluation {

namespace {

constexpr double kNsPerS = 1e9;
/// Largest stamp that fits 64 bits of nanoseconds.
constexpr double kLargestStampS = 9.2e9;

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r'; }

/// Removes the next word from `line` and returns it; empty at the end.
std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_separator(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_separator(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

std::optional<double> parse_number(std::string_view word) {
  const std::optional<double> value = parse_double(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Seconds to nanoseconds. Plain decimals are converted exactly: a double of 1.7e9 s resolves only 240 ns.
std::optional<std::int64_t> parse_stamp_ns(std::string_view word) {
  const std::optional<double> seconds = parse_number(word);
  if (!seconds || std::abs(*seconds) > kLargestStampS) return std::nullopt;
  if (word.find_first_of("eE") != std::string_view::npos) return std::llround(*seconds * kNsPerS);
  const bool negative = word.front() == '-';
  std::int64_t stamp_ns = 0;
  int decimals = -1;  // digits after the point; -1: before it
  for (const char c : word) {
    if (c == '.') decimals = 0;
    if (c < '0' || c > '9') continue;
    if (decimals == 9) break;
    stamp_ns = stamp_ns * 10 + (c - '0');
    if (decimals >= 0) ++decimals;
  }
  for (int digit = std::max(decimals, 0); digit < 9; ++digit) stamp_ns *= 10;
  return negative ? -stamp_ns : stamp_ns;
}

StampedPose parse_pose(std::string_view line, const std::string& where) {
  const std::string_view stamp_word = next_word(line);
  const std::optional<std::int64_t> stamp_ns = parse_stamp_ns(stamp_word);
  if (!stamp_ns)
    throw DataError(where + "the time '" + std::string(stamp_word) + "' is not a number of seconds");
  std::array<double, 7> values{};
  for (double& value : values) {
    const std::string_view word = next_word(line);
    if (word.empty()) throw DataError(where + "a pose has eight numbers: t x y z qx qy qz qw");
    const std::optional<double> number = parse_number(word);
    if (!number) throw DataError(where + "'" + std::string(word) + "' is not a finite number");
    value = *number;
  }
  if (!next_word(line).empty()) throw DataError(where + "a pose has only eight numbers: t x y z qx qy qz qw");
  StampedPose pose{
      *stamp_ns, {values[0], values[1], values[2]}, {values[6], values[3], values[4], values[5]}};
  // Rounding to four decimals gives 1e-4; a larger deviation from unit length is not a rotation.
  if (std::abs(pose.attitude.norm() - 1.0) > 0.01)
    throw DataError(where + "qx qy qz qw is not a unit quaternion");
  pose.attitude.normalize();
  return pose;
}

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
  LineReader lines(text);
  while (const std::optional<std::string_view> line = lines.next()) {
    std::string_view rest = *line;
    const std::string_view first = next_word(rest);
    if (first.empty() || first.front() == '#') continue;
    poses.push_back(parse_pose(*line, name + ":" + std::to_string(lines.line_number()) + ": "));
  }
  if (poses.empty()) throw DataError(name + ": has no pose");
  return make_trajectory(std::move(poses));
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

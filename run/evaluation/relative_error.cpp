// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/relative_error.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::evaluation {

namespace {

// Longest window relative to the wanted length: beyond it the estimate has a gap.
constexpr double kLongestWindowRatio = 1.1;
// Usual steps from pair to pair that a window may be longer: with one pose a second the end lies within one.
constexpr double kGapSteps = 1.5;
// Tolerance for the rounding of summed distances.
constexpr double kRoundingM = 1e-6;

/// Median travel from one pair to the next, of those that travel.
double usual_step_m(const std::vector<PosePair>& pairs) {
  std::vector<double> steps_m;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const double step_m = pairs[i].distance_m - pairs[i - 1].distance_m;
    if (step_m > 0.0) steps_m.push_back(step_m);
  }
  if (steps_m.empty()) return 0.0;
  const auto middle = steps_m.begin() + static_cast<std::ptrdiff_t>(steps_m.size() / 2);
  std::nth_element(steps_m.begin(), middle, steps_m.end());
  return *middle;
}

double longest_window_m(const std::vector<PosePair>& pairs, const WindowOptions& options) {
  return std::max(kLongestWindowRatio * options.length_m, options.length_m + kGapSteps * usual_step_m(pairs));
}

/// Appends the windows within pairs [begin, end).
void append_windows(const std::vector<PosePair>& pairs, std::size_t begin, std::size_t end,
                    const WindowOptions& options, double longest_m, std::vector<Window>& windows) {
  std::size_t last = begin;
  double next_start_m = begin < end ? pairs[begin].distance_m : 0.0;
  for (std::size_t first = begin; first < end; ++first) {
    const double start_m = pairs[first].distance_m + kRoundingM;
    if (start_m < next_start_m) continue;
    next_start_m +=
        options.start_step_m * (std::floor((start_m - next_start_m) / options.start_step_m) + 1.0);
    while (last < end && pairs[last].distance_m < start_m + options.length_m - 2.0 * kRoundingM) ++last;
    if (last == end) return;
    const double travelled_m = pairs[last].distance_m - pairs[first].distance_m;
    if (travelled_m <= longest_m) windows.push_back({first, last, travelled_m});
  }
}

}  // namespace

std::vector<Window> make_windows(const std::vector<PosePair>& pairs, const std::vector<Segment>* segments,
                                 const WindowOptions& options) {
  std::vector<Window> windows;
  const double longest_m = longest_window_m(pairs, options);
  if (segments == nullptr) {
    append_windows(pairs, 0, pairs.size(), options, longest_m, windows);
    return windows;
  }
  for (const Segment& segment : *segments) {
    std::size_t begin = 0;
    while (begin < pairs.size() && pairs[begin].stamp_ns < segment.start_ns) ++begin;
    std::size_t end = begin;
    while (end < pairs.size() && pairs[end].stamp_ns <= segment.end_ns) ++end;
    append_windows(pairs, begin, end, options, longest_m, windows);
  }
  return windows;
}

std::vector<double> relative_z_error(const std::vector<PosePair>& pairs, const std::vector<Window>& windows) {
  const auto height_error_m = [&](std::size_t i) {
    return pairs[i].estimate.position_m.z() - pairs[i].reference.position_m.z();
  };
  std::vector<double> errors;
  errors.reserve(windows.size());
  for (const Window& window : windows) {
    errors.push_back(std::abs(height_error_m(window.last) - height_error_m(window.first)) /
                     window.travelled_m);
  }
  return errors;
}

std::vector<RelativePoseError> relative_pose_error(const std::vector<PosePair>& pairs,
                                                   const std::vector<Window>& windows) {
  std::vector<RelativePoseError> errors;
  errors.reserve(windows.size());
  for (const Window& window : windows) {
    const PosePair& a = pairs[window.first];
    const PosePair& b = pairs[window.last];
    const Eigen::Quaterniond turn_reference = a.reference.attitude.conjugate() * b.reference.attitude;
    const Eigen::Quaterniond turn_estimate = a.estimate.attitude.conjugate() * b.estimate.attitude;
    const Eigen::Vector3d step_reference_m =
        a.reference.attitude.conjugate() * (b.reference.position_m - a.reference.position_m);
    const Eigen::Vector3d step_estimate_m =
        a.estimate.attitude.conjugate() * (b.estimate.position_m - a.estimate.position_m);
    // t(E) = C(A_ref^-1 B_ref)^T (step_estimate - step_reference), and a rotation keeps its length.
    errors.push_back({(step_estimate_m - step_reference_m).norm() / window.travelled_m,
                      turn_reference.angularDistance(turn_estimate) / window.travelled_m});
  }
  return errors;
}

}  // namespace isobar::evaluation

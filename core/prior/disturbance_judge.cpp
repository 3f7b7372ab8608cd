// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/disturbance_judge.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Smallest step: smaller differences occur in still air over three floors.
constexpr double kLeastStepM = 0.3;
// Vertical speed that accelerometer and wheels can miss, beyond the filter's own uncertainty: HeightFilter
// detects the start of every faster lift.
constexpr double kUnfeltSpeedMS = 0.05;
constexpr double kUnfeltSigmas = 4.0;
// Time that a pressure must be steady to count as returned: a broken sensor, and the back swing of a door,
// also cross the old level.
constexpr double kBackS = 0.7;

}  // namespace

bool DisturbanceJudge::fits(const VerticalFilter::Innovation& innovation) const {
  return squared(innovation.value) <= squared(gate_sigma_) * innovation.variance;
}

double DisturbanceJudge::noise_limit_m(const Evidence& evidence) const {
  return gate_sigma_ * std::sqrt(2.0 * evidence.noise_variance_m2);
}

bool DisturbanceJudge::outran_motion(const Evidence& evidence) const {
  if (!has_used_) return false;
  const double since_s = std::max(0.0, seconds_between(used_ns_, evidence.stamp_ns));
  const double limit_m = std::max(kLeastStepM, noise_limit_m(evidence)) +
                         (kUnfeltSpeedMS + kUnfeltSigmas * evidence.climb_sigma_m_s) * since_s;
  // Innovation and height both: a shock to the accelerometer moves only the prediction, a fast lift only the
  // pressure; neither is a step.
  return std::abs(evidence.innovation.value - used_m_) > limit_m &&
         std::abs(evidence.height_m - used_height_m_) > limit_m;
}

void DisturbanceJudge::begin(const Evidence& evidence) {
  gated_ = true;
  unfelt_ = is_back_ = false;
  gated_since_ns_ = steady_since_ns_ = evidence.stamp_ns;
  first_m_ = level_m_ = evidence.innovation.value;
}

void DisturbanceJudge::accept(const Evidence& evidence) {
  gated_ = false;
  has_used_ = true;
  used_m_ = evidence.innovation.value;
  used_height_m_ = evidence.height_m;
  used_ns_ = evidence.stamp_ns;
}

void DisturbanceJudge::watch_steadiness(const Evidence& evidence) {
  const double since_s = std::max(0.0, seconds_between(steady_since_ns_, evidence.stamp_ns));
  const double limit_m = noise_limit_m(evidence) + 2.0 * evidence.climb_sigma_m_s * since_s;
  if (std::abs(evidence.innovation.value - level_m_) <= limit_m) return;
  level_m_ = evidence.innovation.value;
  steady_since_ns_ = evidence.stamp_ns;
}

DisturbanceJudge::Verdict DisturbanceJudge::back(const Evidence& evidence, bool here) {
  // A return rules out step and motion so far: restart their wait.
  gated_since_ns_ = evidence.stamp_ns;
  if (!is_back_) back_since_ns_ = evidence.stamp_ns;
  is_back_ = true;
  const std::int64_t since_ns = std::max(back_since_ns_, steady_since_ns_);
  if (unfelt_ && seconds_between(since_ns, evidence.stamp_ns) < kBackS) return Verdict::kWait;
  accept(evidence);
  return here ? Verdict::kFits : Verdict::kReturned;
}

DisturbanceJudge::Verdict DisturbanceJudge::judge(const Evidence& evidence) {
  const bool here = fits(evidence.innovation);
  if (here && !gated_) {
    accept(evidence);
    return Verdict::kFits;
  }
  if (!gated_) begin(evidence);
  unfelt_ = unfelt_ || outran_motion(evidence);
  watch_steadiness(evidence);
  if (here || (evidence.step_open && fits(evidence.without_step))) return back(evidence, here);
  if (is_back_) first_m_ = evidence.innovation.value;
  is_back_ = false;
  moved_m_ = evidence.innovation.value - first_m_;
  if (seconds_between(gated_since_ns_, evidence.stamp_ns) < evidence.wait_s) return Verdict::kWait;
  if (unfelt_ && seconds_between(steady_since_ns_, evidence.stamp_ns) < evidence.wait_s) {
    return Verdict::kWait;
  }
  accept(evidence);
  // The caller absorbs the innovation: kStep by the step state, kMotion by the height.
  used_m_ = 0.0;
  return unfelt_ ? Verdict::kStep : Verdict::kMotion;
}

}  // namespace isobar

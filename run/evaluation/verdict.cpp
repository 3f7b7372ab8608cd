// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/stamp.hpp"

namespace isobar::evaluation {

namespace {

std::string number(double value, int decimals) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

Verdict lost_at(const PosePair& pair, std::int64_t start_ns, double error_m, double bound_m) {
  return {VerdictKind::kLost, "off by " + number(error_m, 1) + " m at " +
                                  number(seconds_between(start_ns, pair.stamp_ns), 1) + " s and " +
                                  number(pair.distance_m, 0) + " m, beyond " + number(bound_m, 1) + " m"};
}

Verdict incomplete(const std::vector<PosePair>& pairs, const Trajectory& reference, double covered) {
  const double whole_s = reference.duration_s();
  const double before_s = seconds_between(reference.poses.front().stamp_ns, pairs.front().stamp_ns);
  const double after_s = seconds_between(pairs.back().stamp_ns, reference.poses.back().stamp_ns);
  const double gaps_s = (1.0 - covered) * whole_s - before_s - after_s;
  const double noted_s = 0.01 * whole_s;
  std::string reason = "covers " + number(100.0 * covered, 0) + " % of " + number(whole_s, 1) + " s";
  const char* separator = ": ";
  const auto add = [&](double time_s, const std::string& words) {
    if (time_s < noted_s) return;
    reason += separator;
    reason += words;
    separator = ", ";
  };
  add(before_s, "begins " + number(before_s, 1) + " s late");
  add(after_s, "ends " + number(after_s, 1) + " s early");
  add(gaps_s, "gaps of " + number(gaps_s, 1) + " s");
  return {VerdictKind::kIncomplete, std::move(reason)};
}

}  // namespace

const char* verdict_word(VerdictKind kind) {
  switch (kind) {
    case VerdictKind::kOk:
      return "ok";
    case VerdictKind::kIncomplete:
      return "incomplete";
    case VerdictKind::kLost:
      return "LOST";
  }
  return "";
}

Verdict verdict_on(const std::vector<PosePair>& pairs, const Trajectory& reference, double covered,
                   double travelled_m, const VerdictLimits& limits) {
  const double bound_m = std::max(limits.beyond_m, limits.beyond_share_of_distance * travelled_m);
  for (const PosePair& pair : pairs) {
    const double error_m = (pair.estimate.position_m - pair.reference.position_m).norm();
    if (error_m > bound_m) return lost_at(pair, reference.poses.front().stamp_ns, error_m, bound_m);
  }
  return covered < limits.least_coverage ? incomplete(pairs, reference, covered) : Verdict{};
}

}  // namespace isobar::evaluation

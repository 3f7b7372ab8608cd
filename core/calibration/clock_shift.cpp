// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/clock_shift.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isobar {
namespace {

// Number of compared changes: fewer give no significant correlation, more only cost time.
constexpr std::size_t kLeastChanges = 40;
constexpr double kMostChanges = 6'000.0;
// Shortest averaging time, in sample intervals. The noise of a mean over one interval depends on where its
// ends lie between samples, which would favour shifts of half an interval; over four intervals it varies by 2
// %.
constexpr double kLeastIntervals = 4.0;
// Smallest score of a peak, in standard deviations of Fisher's z: below, it is chance among thousands of
// shifts.
constexpr double kLeastScore = 6.0;
// Smallest lead over the next peak, in the same unit: the difference of two scores has a standard deviation
// of 1.4.
constexpr double kLeastLead = 4.0;

/// Change of pressure over the time scale of a comparison.
struct Change {
  double time_s = 0.0;
  double pressure_pa = 0.0;
};

/// Pearson correlation of pairs, from running sums.
class Correlation {
 public:
  void add(double x, double y) {
    n_ += 1.0;
    sx_ += x;
    sy_ += y;
    sxx_ += x * x;
    syy_ += y * y;
    sxy_ += x * y;
  }
  [[nodiscard]] double count() const { return n_; }
  [[nodiscard]] double value() const {
    const double variances = (sxx_ - sx_ * sx_ / n_) * (syy_ - sy_ * sy_ / n_);
    return variances > 0.0 ? (sxy_ - sx_ * sy_ / n_) / std::sqrt(variances) : 0.0;
  }

 private:
  double n_ = 0.0;
  double sx_ = 0.0;
  double sy_ = 0.0;
  double sxx_ = 0.0;
  double syy_ = 0.0;
  double sxy_ = 0.0;
};

/// Changes of both pressures over `scale_s`, and their correlation at a shift.
class Comparison {
 public:
  Comparison(std::span<const PressureSeries> sensor, const PressureSeries& reference, double scale_s)
      : reference_(reference), scale_s_(scale_s) {
    for (const PressureSeries& series : sensor) {
      for (double t = series.begin_s() + 0.5 * scale_s; t + scale_s <= series.end_s(); t += scale_s) {
        const double change = series.mean_pa(t + scale_s, scale_s) - series.mean_pa(t, scale_s);
        if (std::isfinite(change)) changes_.push_back({t, change});
      }
    }
    for (double t = reference.begin_s(); t <= reference.end_s(); t += step_s()) {
      reference_changes_pa_.push_back(reference_change_pa(t));
    }
  }

  [[nodiscard]] std::size_t size() const { return changes_.size(); }
  [[nodiscard]] double scale_s() const { return scale_s_; }
  /// Step of the search: peaks are as wide as the scale, so half of it misses none.
  [[nodiscard]] double step_s() const { return 0.5 * scale_s_; }

  /// Correlation at a shift; 0 if fewer than half of the changes have a counterpart. `used`: number that
  /// have.
  double correlation(double shift_s, double& used) const {
    return correlation_of([&](const Change& change) { return reference_change_pa(change.time_s + shift_s); },
                          used);
  }

  /// Faster approximation: the shift of each change is rounded to whole steps.
  double rough_correlation(double shift_s, double& used) const {
    const auto count = static_cast<double>(reference_changes_pa_.size());
    return correlation_of(
        [&](const Change& change) {
          const double place = std::round((change.time_s + shift_s - reference_.begin_s()) / step_s());
          return place >= 0.0 && place < count ? reference_changes_pa_[static_cast<std::size_t>(place)]
                                               : std::numeric_limits<double>::quiet_NaN();
        },
        used);
  }

 private:
  [[nodiscard]] double reference_change_pa(double time_s) const {
    return reference_.mean_pa(time_s + scale_s_, scale_s_) - reference_.mean_pa(time_s, scale_s_);
  }

  template <typename Counterpart>
  double correlation_of(const Counterpart& counterpart, double& used) const {
    Correlation pairs;
    for (const Change& change : changes_) {
      const double y = counterpart(change);
      if (std::isfinite(y)) pairs.add(change.pressure_pa, y);
    }
    used = pairs.count();
    const bool enough =
        2.0 * used >= static_cast<double>(size()) && used >= static_cast<double>(kLeastChanges);
    return enough ? pairs.value() : 0.0;
  }

  const PressureSeries& reference_;
  double scale_s_;
  std::vector<Change> changes_;
  std::vector<double> reference_changes_pa_;
};

/// Fisher's z of a correlation of `used` pairs, in its standard deviations.
double score(double correlation, double used) {
  return std::atanh(std::clamp(correlation, -0.999999, 0.999999)) * std::sqrt(std::max(1.0, used - 3.0));
}

/// Correlation at all shifts of the search.
struct ShiftScan {
  std::vector<double> shifts_s;
  std::vector<double> correlations;
  std::vector<double> scores;
  std::size_t best = 0;
};

ShiftScan scan_of(const Comparison& comparison, const ShiftSearch& search) {
  ShiftScan scan;
  const double step_s = comparison.step_s();
  const auto steps = static_cast<long>(std::ceil(search.window_s / step_s));
  for (long k = -steps; k <= steps; ++k) {
    double used = 0.0;
    scan.shifts_s.push_back(search.centre_s + static_cast<double>(k) * step_s);
    scan.correlations.push_back(comparison.rough_correlation(scan.shifts_s.back(), used));
    scan.scores.push_back(score(scan.correlations.back(), used));
  }
  scan.best = static_cast<std::size_t>(std::max_element(scan.scores.begin(), scan.scores.end()) -
                                       scan.scores.begin());
  return scan;
}

/// Index of the best shift outside the peak (bounded by half its correlation); scan.best if there is none.
std::size_t next_best(const ShiftScan& scan) {
  const double half = 0.5 * scan.correlations[scan.best];
  std::size_t left = scan.best;
  std::size_t right = scan.best;
  while (left > 0 && scan.correlations[left] > half) --left;
  while (right + 1 < scan.shifts_s.size() && scan.correlations[right] > half) ++right;
  std::size_t found = scan.best;
  for (std::size_t k = 0; k < scan.shifts_s.size(); ++k) {
    const bool is_outside = k < left || k > right;
    if (is_outside && (found == scan.best || scan.scores[k] > scan.scores[found])) found = k;
  }
  return found;
}

/// Lead in score of the peak over the next best shift.
double lead(const ShiftScan& scan) {
  const std::size_t next = next_best(scan);
  return next == scan.best ? 0.0 : scan.scores[scan.best] - std::max(0.0, scan.scores[next]);
}

/// Golden-section search around the best shift; uncertainty from the curvature of the peak.
void refine(const Comparison& comparison, const ShiftScan& scan, ClockShift& result) {
  constexpr double kGolden = 0.6180339887498949;
  const double step_s = comparison.step_s();
  double used = 0.0;
  double low = scan.shifts_s[scan.best] - 1.5 * step_s;
  double high = scan.shifts_s[scan.best] + 1.5 * step_s;
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double at_a = comparison.correlation(a, used);
  double at_b = comparison.correlation(b, used);
  while (high - low > 1e-3 * step_s) {
    if (at_a > at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = comparison.correlation(a, used);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = comparison.correlation(b, used);
    }
  }
  result.shift_s = 0.5 * (low + high);
  const double r = comparison.correlation(result.shift_s, used);
  result.correlation = r;
  const double r_left = comparison.correlation(result.shift_s - step_s, used);
  const double r_right = comparison.correlation(result.shift_s + step_s, used);
  const double curvature = (2.0 * r - r_left - r_right) / (step_s * step_s);
  (void)comparison.correlation(result.shift_s, used);
  result.changes = static_cast<std::size_t>(used);
  // The log-likelihood -n/2 ln(1 - r^2) drops by 1/2 at one standard deviation.
  result.sigma_s = curvature > 0.0 ? std::sqrt((1.0 - r * r) / (used * r * curvature))
                                   : std::numeric_limits<double>::infinity();
}

std::string doubt_of(const ShiftScan& scan) {
  if (!(scan.scores[scan.best] >= kLeastScore)) return "the two logs do not correlate at any shift";
  if (scan.best == 0 || scan.best + 1 == scan.shifts_s.size()) {
    return "the correlation peaks at the end of the search window";
  }
  const std::size_t next = next_best(scan);
  if (next == scan.best) return "the logs correlate equally at every shift";
  if (lead(scan) < kLeastLead) return "the logs correlate almost equally at two shifts";
  return {};
}

ClockShift shift_of(const Comparison& comparison, const ShiftScan& scan) {
  ClockShift result;
  refine(comparison, scan, result);
  const std::size_t next = next_best(scan);
  if (next != scan.best) {
    result.next_best_shift_s = scan.shifts_s[next];
    result.next_best_correlation = scan.correlations[next];
  }
  result.scale_s = comparison.scale_s();
  result.doubt = doubt_of(scan);
  return result;
}

double longer_interval_s(std::span<const PressureSeries> sensor, const PressureSeries& reference,
                         double& duration_s) {
  double interval_s = reference.interval_s();
  duration_s = 0.0;
  for (const PressureSeries& series : sensor) {
    if (series.size() < 2) continue;
    interval_s = std::max(interval_s, series.interval_s());
    duration_s += series.end_s() - series.begin_s();
  }
  return interval_s;
}

}  // namespace

ClockShift find_clock_shift(std::span<const PressureSeries> sensor, const PressureSeries& reference,
                            const ShiftSearch& search) {
  double duration_s = 0.0;
  const double interval_s = longer_interval_s(sensor, reference, duration_s);
  ClockShift result;
  result.doubt = "the logs are too short";
  if (!(interval_s > 0.0)) return result;
  double largest_lead = -1.0;
  for (double scale_s = std::max(kLeastIntervals * interval_s, duration_s / kMostChanges);
       duration_s >= static_cast<double>(kLeastChanges) * scale_s && scale_s <= search.window_s;
       scale_s *= 2.0) {
    const Comparison comparison(sensor, reference, scale_s);
    if (comparison.size() < kLeastChanges) break;
    const ShiftScan scan = scan_of(comparison, search);
    const ClockShift candidate = shift_of(comparison, scan);
    // The sharpest credible peak; if no peak is credible, the one with the largest lead.
    const bool is_better = candidate.doubt.empty()
                               ? !result.doubt.empty() || candidate.sigma_s < result.sigma_s
                               : !result.doubt.empty() && lead(scan) > largest_lead;
    if (!is_better) continue;
    largest_lead = lead(scan);
    result = candidate;
  }
  return result;
}

}  // namespace isobar

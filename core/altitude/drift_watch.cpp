// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/drift_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/altitude/base_station.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// A longer gap: what lies between is unknown.
constexpr double kDriftGapS = 3.0;
// Least change of a drift in each window [m]: beyond turbulence, and in the shortest beyond two zones at once.
constexpr std::array<double, 6> kLeastDriftM{0.5, 0.17, 0.13, 0.12, 0.11, 0.10};
// Error of a map's height with the way: a slope.
constexpr double kHeightErrorShare = 0.004;
// Change of a drift in standard deviations of an airflow that is not known yet: a start or a stop is no drift.
constexpr double kAirflowSigmas = 2.5;
// Largest rms of the residuals about the line, and largest part of two tenths of the window, as shares of the change.
constexpr double kLargestRms = 0.11;
constexpr std::array<double, 6> kLargestFifth{0.42, 0.39, 0.42, 0.42, 0.42, 0.42};
// Least part of the last tenth: the drift goes on.
constexpr double kLeastLast = 0.05;
// Unrest of the air: lag of its second differences [bins], their variance over that of the air for a correlation time of
// four seconds, time of the mean [bins], and largest square as a multiple of the mean: a zone is no unrest.
constexpr std::size_t kUnrestLag = 8;
constexpr double kUnrestFactor = 3.3;
constexpr double kUnrestBins = 120.0;
constexpr double kUnrestClip = 9.0;
// Step of a zone, from 1 Pa on: change within so many bins, beyond multiples of the line.
constexpr std::size_t kStepBins = 4;
constexpr double kLeastStepM = 0.07;
constexpr double kStepLines = 1.5;
// Change of a drift in standard deviations of that unrest, in each window: over ten to forty seconds it looks like a line
// most often, over longer ones it averages out.
constexpr std::array<double, 6> kUnrestSigmas{5.0, 5.5, 7.0, 6.0, 4.5, 3.5};
// A drift counts as over when no window has shown it for this long.
constexpr int kQuietBins = 20;
// Without a base station the weather is the altimeter's, of which 12 Pa are a metre.
constexpr double kMetresPerPa = 0.085;
// Ratio of the two barometers' changes from which on one is named.
constexpr double kClearRatio = 2.0;

// Change along the line of least squares through equidistant values.
template <std::size_t N>
double change_along_line(const std::array<double, N>& y) {
  constexpr double kMiddle = 0.5 * (N - 1);
  constexpr double kSquares = N * (N * N - 1.0) / 12.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i) sum += (static_cast<double>(i) - kMiddle) * y[i];
  return sum / kSquares * (N - 1);
}

template <std::size_t N>
double rms_about_line(const std::array<double, N>& y, double change) {
  double mean = 0.0;
  for (const double value : y) mean += value / N;
  double squares = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    const double line = mean + change * (static_cast<double>(i) / (N - 1) - 0.5);
    squares += (y[i] - line) * (y[i] - line);
  }
  return std::sqrt(squares / (N - 2));
}

template <std::size_t N>
bool is_line(const std::array<double, N>& y, double change, double largest_fifth) {
  if (rms_about_line(y, change) > kLargestRms * std::abs(change)) return false;
  const double sign = change > 0.0 ? 1.0 : -1.0;
  for (std::size_t i = 2; i < N; ++i) {
    if (sign * (y[i] - y[i - 2]) > largest_fifth * std::abs(change)) return false;
  }
  return sign * (y[N - 1] - y[N - 2]) > kLeastLast * std::abs(change);
}

DriftSuspect owner_of(double change_m, double base_m) {
  const double robot_m = change_m - base_m;
  if (std::abs(base_m) > kClearRatio * std::abs(robot_m)) return DriftSuspect::kBase;
  if (std::abs(robot_m) > kClearRatio * std::abs(base_m)) return DriftSuspect::kRobot;
  return DriftSuspect::kUnknown;
}

}  // namespace

void DriftWatch::add(const Reading& reading) {
  const bool gap = last_ns_ != 0 &&
                   (reading.stamp_ns < last_ns_ || seconds_between(last_ns_, reading.stamp_ns) > kDriftGapS);
  if (gap || reading.base != base_) restart();
  if (open_count_ > 0 && seconds_between(open_ns_, reading.stamp_ns) >= kBinS) close();
  if (open_count_ == 0) open_ns_ = reading.stamp_ns;
  open_.residual_m += reading.residual_m;
  open_.base_m += reading.base_m;
  open_.way_m += reading.way_m;
  open_.airflow_sd_m += reading.airflow_sd_m;
  ++open_count_;
  last_ns_ = reading.stamp_ns;
  base_ = reading.base;
}

void DriftWatch::close() {
  bins_[next_] = {open_.residual_m / open_count_, open_.base_m / open_count_, open_.way_m,
                  open_.airflow_sd_m / open_count_};
  next_ = (next_ + 1) % kBins;
  count_ = std::min(count_ + 1, kBins);
  open_ = {};
  open_count_ = 0;
  learn_unrest();
  judge();
}

void DriftWatch::learn_unrest() {
  if (count_ <= 2 * kUnrestLag) return;
  const double second =
      back(0).residual_m - 2.0 * back(kUnrestLag).residual_m + back(2 * kUnrestLag).residual_m;
  const double square = std::min(second * second / kUnrestFactor, kUnrestClip * unrest_m2_);
  unrest_m2_ = std::max(kLeastUnrestM2, unrest_m2_ + (square - unrest_m2_) / kUnrestBins);
}

DriftWatch::Window DriftWatch::window(std::size_t bins_a_part) const {
  Window out;
  const std::size_t length = kParts * bins_a_part;
  double least_m = back(0).airflow_sd_m;
  double largest_m = least_m;
  for (std::size_t i = 0; i < length; ++i) {
    const Bin& bin = bins_[(next_ + kBins - length + i) % kBins];
    const std::size_t part = i / bins_a_part;
    out.residual_m[part] += bin.residual_m / static_cast<double>(bins_a_part);
    out.base_m[part] += bin.base_m / static_cast<double>(bins_a_part);
    out.way_m += bin.way_m;
    least_m = std::min(least_m, bin.airflow_sd_m);
    largest_m = std::max(largest_m, bin.airflow_sd_m);
  }
  out.airflow_sd_m = largest_m - least_m;
  return out;
}

// Sum of the steps in the newest `length` bins, beyond the line: zones, of which a stair looks like a line.
double DriftWatch::steps_m(std::size_t length, double rate_m_s) const {
  const double line_m = rate_m_s * kBinS * kStepBins;
  const double least_m = kLeastStepM + kStepLines * std::abs(line_m);
  const auto change_m = [&](std::size_t age) {
    return age + kStepBins < length ? back(age).residual_m - back(age + kStepBins).residual_m : 0.0;
  };
  double sum_m = 0.0;
  for (std::size_t age = 0; age + kStepBins < length; ++age) {
    const double here_m = change_m(age);
    const bool whole =
        std::abs(here_m) >= std::abs(change_m(age + 1)) && std::abs(here_m) >= std::abs(change_m(age + 2));
    if (std::abs(here_m) < least_m || !whole) continue;
    sum_m += here_m - line_m;
    age += kStepBins - 1;
  }
  return sum_m;
}

void DriftWatch::judge() {
  ++quiet_bins_;
  std::size_t bins_a_part = 1;
  for (std::size_t i = 0; i < kLeastDriftM.size(); ++i) {
    const std::size_t length = kParts * bins_a_part;
    if (length > count_) break;
    const Window seen = window(bins_a_part);
    const double window_s = kBinS * static_cast<double>(length);
    const double change_m = change_along_line(seen.residual_m);
    const double weather_m = base_ ? 0.0 : kLargestWeatherSigmas * kMetresPerPa * weather_sigma_pa(window_s);
    const double allowed_m = std::max({kLeastDriftM[i], kUnrestSigmas[i] * std::sqrt(unrest_m2_),
                                       kAirflowSigmas * seen.airflow_sd_m}) +
                             kHeightErrorShare * seen.way_m + weather_m;
    const double rate_m_s = change_m / (window_s * (1.0 - 1.0 / kParts));
    const double by_steps_m = std::copysign(1.0, change_m) * steps_m(length, rate_m_s);
    const double even_m = std::abs(change_m) - std::max(0.0, by_steps_m);
    if (even_m > allowed_m && is_line(seen.residual_m, change_m, kLargestFifth[i])) {
      // Whom one window has named stays named: turbulence blurs later ones.
      if (suspect_ == DriftSuspect::kNone || suspect_ == DriftSuspect::kUnknown) {
        suspect_ = owner_of(change_m, change_along_line(seen.base_m));
      }
      rate_m_s_ = rate_m_s;
      quiet_bins_ = 0;
      return;
    }
    bins_a_part *= 2;
  }
  if (quiet_bins_ < kQuietBins) return;
  suspect_ = DriftSuspect::kNone;
  rate_m_s_ = 0.0;
}

}  // namespace isobar

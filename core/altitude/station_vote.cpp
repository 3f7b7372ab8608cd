// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/station_vote.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/altitude/base_station.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Averaging time: reduces turbulence and noise, short against a drift.
constexpr double kMeanS = 2.0;
// Ratio of the two deviations, of each station's change of pressure from the robot's, above which the station
// with the larger deviation is wrong.
constexpr double kNearerRatio = 2.0;
// Smallest divergence for a decision: more than turbulence at the robot (0.2 Pa) and the error of slipping
// wheels on a climb within the averaging time.
constexpr double kLeastDivergencePa = 0.5;
// Pressure per unit of ln p: sea-level pressure, accurate enough for the limits above.
constexpr double kPaPerLog = 1e5;

}  // namespace

void StationVote::Mean::add(const Sample& sample) {
  first_log += sample.first_log;
  second_log += sample.second_log;
  robot_known = robot_known && std::isfinite(sample.robot_log);
  if (robot_known) robot_log += sample.robot_log;
  ++count;
}

StationVote::Sample StationVote::Mean::value() const {
  return {first_log / count, second_log / count,
          robot_known ? robot_log / count : std::numeric_limits<double>::quiet_NaN()};
}

void StationVote::restart() { *this = StationVote(); }

void StationVote::add(std::int64_t stamp_ns, const Sample& sample, bool agree) {
  if (open_.count == 0) opened_ns_ = stamp_ns;
  open_.add(sample);
  if (seconds_between(opened_ns_, stamp_ns) >= kMeanS) close(stamp_ns, agree);
}

void StationVote::close(std::int64_t stamp_ns, bool agree) {
  newest_ = open_.value();
  newest_ns_ = stamp_ns;
  has_newest_ = true;
  open_ = Mean();
  const auto known = [](const Sample& sample) { return std::isfinite(sample.robot_log); };
  broken_ = broken_ || !known(newest_);
  if (!agree) return;
  // Keep several means: the smoothed difference lags, so the newest "agreeing" mean may include the drift.
  if (agreed_count_ == kKept) {
    std::move(agreed_.begin() + 1, agreed_.end(), agreed_.begin());
    --agreed_count_;
  }
  agreed_[agreed_count_++] = newest_;
  agreed_ns_ = stamp_ns;
  broken_ =
      !std::all_of(agreed_.begin(), agreed_.begin() + static_cast<std::ptrdiff_t>(agreed_count_), known);
}

int StationVote::wrong() const {
  if (agreed_count_ == 0 || !has_newest_) return -1;
  const Sample& before = agreed_.front();
  const double first_pa = kPaPerLog * (newest_.first_log - before.first_log);
  const double second_pa = kPaPerLog * (newest_.second_log - before.second_log);
  if (std::abs(first_pa - second_pa) < kLeastDivergencePa) return -1;
  if (!broken_) {
    const double robot_pa = kPaPerLog * (newest_.robot_log - before.robot_log);
    const double to_first_pa = std::abs(first_pa - robot_pa);
    const double to_second_pa = std::abs(second_pa - robot_pa);
    if (to_first_pa > kNearerRatio * to_second_pa) return 0;
    if (to_second_pa > kNearerRatio * to_first_pa) return 1;
  }
  const double elapsed_s = seconds_between(agreed_ns_, newest_ns_) + static_cast<double>(kKept) * kMeanS;
  const double weather_pa = kLargestWeatherSigmas * weather_sigma_pa(elapsed_s);
  const bool first_too_fast = std::abs(first_pa) > weather_pa;
  const bool second_too_fast = std::abs(second_pa) > weather_pa;
  if (first_too_fast == second_too_fast) return -1;
  return first_too_fast ? 0 : 1;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/air_change.hpp"

#include <algorithm>
#include <cmath>

#include "core/altitude/base_station.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

constexpr double kOpenS = 1.0;
// A longer gap: what lies between is unknown.
constexpr double kGapS = 5.0;
// Allowance for noise and turbulence of a mean of a second, and for the climb's error of 1 cm/s.
constexpr double kUnrestPa = 1.0;
constexpr double kClimbErrorPaS = 0.12;

}  // namespace

void AirChange::add(std::int64_t stamp_ns, double robot_air_log, double base_log) {
  if (open_count_ > 0 && seconds_between(open_.stamp_ns, stamp_ns) >= kOpenS) close();
  if (count_ > 0 && seconds_between(mean(0).stamp_ns, stamp_ns) > kGapS) restart();
  if (open_count_ == 0) open_ = {stamp_ns, 0.0, 0.0};
  open_.robot_log += robot_air_log;
  open_.base_log += base_log;
  ++open_count_;
}

void AirChange::close() {
  means_[next_] = {open_.stamp_ns, open_.robot_log / open_count_, open_.base_log / open_count_};
  next_ = (next_ + 1) % kKeptS;
  count_ = std::min(count_ + 1, kKeptS);
  open_count_ = 0;
}

AirChange::Change AirChange::over(std::size_t seconds) const {
  if (count_ < 2) return {};
  const Mean& newest = mean(0);
  const Mean& before = mean(std::min(seconds, count_ - 1));
  const double pressure_pa = std::exp(newest.robot_log);
  return {seconds_between(before.stamp_ns, newest.stamp_ns),
          pressure_pa * (newest.robot_log - before.robot_log),
          pressure_pa * (newest.base_log - before.base_log)};
}

DriftSuspect AirChange::suspect() const {
  if (count_ < kLeastS) return DriftSuspect::kNone;
  // Short first: a fast drift is seen before the air has moved.
  for (const std::size_t seconds : {std::size_t{5}, std::size_t{10}, std::size_t{20}, kKeptS - 1}) {
    const Change change = over(seconds);
    const double allowed_pa = kUnrestPa + kLargestWeatherSigmas * weather_sigma_pa(change.over_s);
    const double allowed_robot_pa = allowed_pa + kClimbErrorPaS * change.over_s;
    if (std::abs(change.robot_pa - change.base_pa) <= allowed_robot_pa) continue;
    const bool robot = std::abs(change.robot_pa) > allowed_robot_pa;
    const bool base = std::abs(change.base_pa) > allowed_pa;
    if (robot != base) return robot ? DriftSuspect::kRobot : DriftSuspect::kBase;
    if (robot) return DriftSuspect::kUnknown;
  }
  return DriftSuspect::kNone;
}

}  // namespace isobar

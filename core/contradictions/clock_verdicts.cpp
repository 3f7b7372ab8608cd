// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/clock_verdicts.hpp"

#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "core/contradictions/motion_comparison.hpp"

namespace isobar {

namespace {

constexpr double kLeastCorrelation = 0.6;
constexpr double kZeroShare = 0.5;
// A second lag that fits nearly as well is a lap that repeats itself, or chance where the best fits badly.
constexpr double kGoodCorrelation = 0.8;
constexpr double kSecondShare = 0.75;
constexpr double kSecondShareOfGood = 0.9;
// A lag shorter than a turn leaves most of the correlation: what is missing to 1 must shrink threefold.
constexpr double kBestCorrelation = 0.9;
constexpr double kMissingFactor = 3.0;
constexpr double kMissingMore = 0.03;
constexpr double kLagLeastTurnRad = 1.5;
constexpr std::int64_t kLeastLagCells = 4;
constexpr double kCellSeconds = static_cast<double>(MotionSeries::kCellNs) * 1e-9;
// Lags that count as one: two sensors apart from the third by the same.
constexpr double kSameLagS = 0.3;

const StreamTimes& times_of(const AllStreamTimes& times, CheckedSensor sensor) {
  return times[static_cast<std::size_t>(sensor)];
}

bool is_credible(const TurnLag& lag) {
  if (lag.turned_rad < kLagLeastTurnRad || std::abs(lag.lag_cells) < kLeastLagCells) return false;
  if (lag.correlation < kLeastCorrelation) return false;
  const double second = lag.correlation >= kGoodCorrelation ? kSecondShareOfGood : kSecondShare;
  if (lag.second > second * lag.correlation) return false;
  const bool stands_out = lag.correlation >= kBestCorrelation &&
                          1.0 - lag.at_zero >= kMissingFactor * (1.0 - lag.correlation) + kMissingMore;
  return stands_out || lag.at_zero <= kZeroShare * lag.correlation;
}

/// A search around a clock that is right, then around files that begin together.
std::optional<Finding> lag_of(const MotionSeries& sensor, const MotionSeries& reference, CheckedSensor which,
                              CheckedSensor other) {
  if (sensor.empty() || reference.empty()) return {};
  const std::int64_t begins_apart = sensor.first() - reference.first();
  for (const std::int64_t centre : {std::int64_t{0}, begins_apart}) {
    const TurnLag lag = find_turn_lag(sensor, reference, centre);
    if (!is_credible(lag)) continue;
    return Finding{.kind = Contradiction::kClocksApart,
                   .sensor = which,
                   .other = other,
                   .measured = kCellSeconds * static_cast<double>(lag.lag_cells),
                   .confidence = lag.correlation,
                   .evidence = lag.turned_rad};
  }
  return {};
}

}  // namespace

void add_missing_overlaps(const AllStreamTimes& times, Findings& findings) {
  const StreamTimes& lidar = times_of(times, CheckedSensor::kLidar);
  if (lidar.count() == 0) return;
  Findings apart;
  int heard = 0;
  for (const CheckedSensor sensor :
       {CheckedSensor::kImu, CheckedSensor::kBarometer, CheckedSensor::kWheels}) {
    const StreamTimes& stream = times_of(times, sensor);
    heard += stream.count() > 0 ? 1 : 0;
    if (stream.count() == 0 || overlap_s(stream, lidar) >= 0.0) continue;
    apart.add({.kind = Contradiction::kNoOverlap,
               .sensor = sensor,
               .other = CheckedSensor::kLidar,
               .measured = seconds_between(lidar.first_ns(), stream.first_ns()),
               .confidence = 1.0,
               .evidence = -overlap_s(stream, lidar)});
  }
  const auto all = apart.all();
  const bool lidar_alone = heard > 1 && static_cast<int>(all.size()) == heard &&
                           overlap_s(times_of(times, all[0].sensor), times_of(times, all[1].sensor)) >= 0.0;
  for (std::size_t i = 0; i < (lidar_alone ? 1 : all.size()); ++i) {
    Finding finding = all[i];
    if (lidar_alone) std::swap(finding.sensor, finding.other);
    if (lidar_alone) finding.measured = -finding.measured;
    findings.add(finding);
  }
}

void add_clock_findings(const TurnStreams& turns, const AllStreamTimes& times, Findings& findings) {
  const auto overlaps = [&](CheckedSensor sensor) {
    return overlap_s(times_of(times, sensor), times_of(times, CheckedSensor::kLidar)) >= 0.0;
  };
  const auto gyro = overlaps(CheckedSensor::kImu)
                        ? lag_of(turns.gyro, turns.scans, CheckedSensor::kImu, CheckedSensor::kLidar)
                        : std::nullopt;
  const auto wheels = overlaps(CheckedSensor::kWheels)
                          ? lag_of(turns.wheels, turns.scans, CheckedSensor::kWheels, CheckedSensor::kLidar)
                          : std::nullopt;
  if (gyro && wheels && std::abs(gyro->measured - wheels->measured) <= kSameLagS) {
    // Both against the lidar by the same: its clock is the one that is off.
    Finding lidar = *gyro;
    lidar.sensor = CheckedSensor::kLidar;
    lidar.other = CheckedSensor::kImu;
    lidar.measured = -gyro->measured;
    findings.add(lidar);
    return;
  }
  if (gyro) findings.add(*gyro);
  if (wheels) findings.add(*wheels);
  // Where scans tell no turn, the wheels are the reference.
  if (gyro || wheels || !overlaps(CheckedSensor::kImu)) return;
  const TurnRatio seen = compare_turns(turns.gyro, turns.scans);
  if (seen.windows > 0) return;
  if (const auto lag = lag_of(turns.gyro, turns.wheels, CheckedSensor::kImu, CheckedSensor::kWheels)) {
    findings.add(*lag);
  }
}

}  // namespace isobar

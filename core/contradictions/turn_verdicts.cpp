// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/turn_verdicts.hpp"

#include <cmath>

#include "core/geometry.hpp"
#include "core/plausibility.hpp"

namespace isobar {

namespace {

constexpr double kCorrelated = 0.9;
constexpr double kDegreesLeastTurnRad = 0.3;
constexpr int kDegreesLeastWindows = 2;
constexpr double kSignLeastTurnRad = 0.7;
constexpr int kSignLeastWindows = 3;
constexpr PlausibleRange kSameTurn{0.5, 2.0};
constexpr PlausibleRange kDegreeFactor{40.0, 80.0};

Finding turn_finding(Contradiction kind, CheckedSensor sensor, CheckedSensor other, const TurnRatio& turn) {
  return {.kind = kind,
          .sensor = sensor,
          .other = other,
          .measured = turn.ratio,
          .confidence = std::abs(turn.correlation),
          .evidence = turn.turned_rad};
}

/// The better of both references of the gyro that says something of this kind; null: none.
const TurnRatio* saying(TurnVerdict verdict, const TurnRatio& by_wheels, const TurnRatio& by_scans) {
  if (verdict_on(by_wheels) == verdict) return &by_wheels;
  return verdict_on(by_scans) == verdict ? &by_scans : nullptr;
}

void add_gyro_unit(const TurnComparisons& turns, Findings& findings) {
  for (const TurnVerdict verdict : {TurnVerdict::kDegrees, TurnVerdict::kRadiansTwice}) {
    const TurnRatio* turn = saying(verdict, turns.gyro_by_wheels, turns.gyro_by_scans);
    if (turn == nullptr) continue;
    // Wheels that turn 57 times as fast as the scans are the ones that err.
    if (verdict_on(turns.wheels_by_scans) == TurnVerdict::kDegrees ||
        verdict_on(turns.wheels_by_scans) == TurnVerdict::kRadiansTwice) {
      continue;
    }
    const bool by_wheels = turn == &turns.gyro_by_wheels;
    Finding finding = turn_finding(Contradiction::kGyroUnit, CheckedSensor::kImu,
                                   by_wheels ? CheckedSensor::kWheels : CheckedSensor::kLidar, *turn);
    finding.remedy[0] = verdict == TurnVerdict::kDegrees ? kRadPerDeg : 1.0 / kRadPerDeg;
    findings.add(finding);
  }
}

void add_wheel_unit(const TurnRatio& wheels, Findings& findings) {
  const TurnVerdict verdict = verdict_on(wheels);
  if (verdict != TurnVerdict::kDegrees && verdict != TurnVerdict::kRadiansTwice) return;
  Finding finding =
      turn_finding(Contradiction::kWheelTurnUnit, CheckedSensor::kWheels, CheckedSensor::kLidar, wheels);
  finding.remedy[0] = verdict == TurnVerdict::kDegrees ? kRadPerDeg : 1.0 / kRadPerDeg;
  findings.add(finding);
}

}  // namespace

TurnVerdict verdict_on(const TurnRatio& turn) {
  const double correlation = std::abs(turn.correlation);
  if (correlation < kCorrelated || turn.windows < kDegreesLeastWindows) return TurnVerdict::kUnclear;
  const double size = std::abs(turn.ratio);
  if (turn.turned_rad >= kDegreesLeastTurnRad && kDegreeFactor.holds(size)) return TurnVerdict::kDegrees;
  if (turn.windows < kSignLeastWindows || turn.turned_rad < kSignLeastTurnRad) return TurnVerdict::kUnclear;
  if (kDegreeFactor.holds(1.0 / size)) return TurnVerdict::kRadiansTwice;
  if (!kSameTurn.holds(size)) return TurnVerdict::kUnclear;
  return turn.ratio > 0.0 ? TurnVerdict::kAgree : TurnVerdict::kOpposite;
}

void add_turn_findings(const TurnComparisons& turns, bool points_down, Findings& findings) {
  add_gyro_unit(turns, findings);
  add_wheel_unit(turns.wheels_by_scans, findings);
  const bool gyro_against_scans = verdict_on(turns.gyro_by_scans) == TurnVerdict::kOpposite;
  const bool gyro_against_wheels = verdict_on(turns.gyro_by_wheels) == TurnVerdict::kOpposite;
  const bool wheels_against_scans = verdict_on(turns.wheels_by_scans) == TurnVerdict::kOpposite;
  if (wheels_against_scans) {
    // An IMU that is upside down turns the wrong way itself and is no witness.
    const bool scans_alone = gyro_against_scans && !points_down;
    findings.add(scans_alone ? turn_finding(Contradiction::kLidarMirrored, CheckedSensor::kLidar,
                                            CheckedSensor::kWheels, turns.wheels_by_scans)
                             : turn_finding(Contradiction::kWheelTurnReversed, CheckedSensor::kWheels,
                                            CheckedSensor::kLidar, turns.wheels_by_scans));
    return;
  }
  if (points_down) return;  // the mount explains the sign
  const bool scans_agree = verdict_on(turns.gyro_by_scans) == TurnVerdict::kAgree;
  const bool wheels_agree = verdict_on(turns.gyro_by_wheels) == TurnVerdict::kAgree;
  if ((gyro_against_scans && !wheels_agree) || (gyro_against_wheels && !scans_agree)) {
    findings.add(turn_finding(Contradiction::kGyroMirrored, CheckedSensor::kImu,
                              gyro_against_wheels ? CheckedSensor::kWheels : CheckedSensor::kLidar,
                              gyro_against_wheels ? turns.gyro_by_wheels : turns.gyro_by_scans));
  }
}

}  // namespace isobar

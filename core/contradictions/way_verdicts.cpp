// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/way_verdicts.hpp"

#include <cmath>

#include "core/geometry.hpp"
#include "core/plausibility.hpp"

namespace isobar {

namespace {

constexpr double kSteady = 0.9;
constexpr double kLeastWayTotalM = 2.0;
constexpr int kLeastWayWindows = 3;
constexpr double kLeastAngleDeg = 20.0;
constexpr double kBackwardsDeg = 150.0;
constexpr PlausibleRange kSameWay{0.4, 2.5};
// Correlation of accelerations that tells forwards from backwards.
constexpr double kTellingAcceleration = 0.5;

/// Angle beyond -180 up to 180 deg.
double wrapped_deg(double angle_deg) {
  const double wrapped = std::remainder(angle_deg, 360.0);
  return wrapped <= -180.0 ? 180.0 : wrapped;
}

Finding way_finding(Contradiction kind, const WayRatio& way) {
  return {.kind = kind,
          .sensor = CheckedSensor::kWheels,
          .other = CheckedSensor::kLidar,
          .measured = way.ratio,
          .confidence = way.correlation,
          .evidence = way.way_m};
}

Finding lidar_finding(Contradiction kind, const WayRatio& way, const Eigen::Vector3d& lidar_rpy_deg) {
  Finding finding = way_finding(kind, way);
  finding.sensor = CheckedSensor::kLidar;
  finding.other = CheckedSensor::kWheels;
  finding.measured = way.angle_rad / kRadPerDeg;
  // A right angle where one is meant.
  const double right_deg = 90.0 * std::round(finding.measured / 90.0);
  const bool is_right = std::abs(finding.measured - right_deg) < 10.0 && right_deg != 0.0;
  const double turn_deg = is_right ? right_deg : std::round(finding.measured);
  finding.remedy = {lidar_rpy_deg.x(), lidar_rpy_deg.y(), wrapped_deg(lidar_rpy_deg.z() - turn_deg)};
  return finding;
}

Contradiction backwards(const WayWitnesses& witnesses) {
  if (witnesses.wheels_turn_reversed) return Contradiction::kWheelsReversed;
  const double acceleration = witnesses.acceleration.value_or(0.0);
  if (acceleration > kTellingAcceleration) return Contradiction::kLidarYaw;
  return acceleration < -kTellingAcceleration ? Contradiction::kWheelsReversed
                                              : Contradiction::kWheelsOrLidar;
}

}  // namespace

void add_way_findings(const WayRatio& way, const WayWitnesses& witnesses,
                      const Eigen::Vector3d& lidar_rpy_deg, Findings& findings) {
  if (way.windows < kLeastWayWindows || way.way_m < kLeastWayTotalM || way.correlation < kSteady) return;
  const double angle_deg = std::abs(way.angle_rad) / kRadPerDeg;
  if (angle_deg > kBackwardsDeg) {
    const Contradiction kind = backwards(witnesses);
    Finding finding = lidar_finding(kind, way, lidar_rpy_deg);
    if (kind != Contradiction::kLidarYaw) {
      finding.sensor = CheckedSensor::kWheels;
      finding.other = CheckedSensor::kLidar;
    }
    findings.add(finding);
  } else if (angle_deg > kLeastAngleDeg) {
    findings.add(lidar_finding(Contradiction::kLidarYaw, way, lidar_rpy_deg));
  }
  if (kSameWay.holds(way.ratio)) return;
  Finding finding = way_finding(Contradiction::kWheelUnit, way);
  finding.remedy[0] = 1.0 / way.ratio;
  findings.add(finding);
}

}  // namespace isobar

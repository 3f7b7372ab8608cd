// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/finding_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace isobar {

namespace {

std::string number_text(double value, std::chars_format format, int precision) {
  std::array<char, 64> text{};
  // + 0.0: no "-0".
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value + 0.0, format, precision);
  return end.ec == std::errc() ? std::string(text.data(), end.ptr) : "?";
}
std::string fixed(double value, int decimals) {
  return number_text(value, std::chars_format::fixed, decimals);
}
/// With so many significant digits, without trailing zeros.
std::string general(double value, int digits) {
  return number_text(value, std::chars_format::general, digits);
}

std::string would_fit_text(const char* key, const std::array<double, 3>& rpy_deg) {
  return std::string(key) + " = [" + general(rpy_deg[0], 6) + ", " + general(rpy_deg[1], 6) + ", " +
         general(rpy_deg[2], 6) + "] would fit";
}

const char* noun(CheckedSensor sensor) {
  constexpr std::array<const char*, kCheckedSensors> kNouns{"lidar", "IMU", "barometer",
                                                            "base station's barometer", "wheels"};
  return kNouns[static_cast<std::size_t>(sensor)];
}

const char* turner(CheckedSensor sensor) { return sensor == CheckedSensor::kWheels ? "wheels" : "scans"; }

std::string gravity_text(const Finding& finding) {
  // The specific force of a robot at rest points up; where the mount makes it point down, gravity points up.
  const std::string mount = would_fit_text("imu.rpy_deg", finding.remedy);
  if (finding.measured > 135.0) {
    return "gravity points up: " + mount + ", or the accelerations have the wrong sign";
  }
  return "gravity points to the side, " + fixed(finding.measured, 0) + " deg from down: " + mount;
}

std::string times_text(double ratio) {
  const double size = std::abs(ratio);
  return (size >= 9.5 ? fixed(size, 0) : general(size, 2)) + " times";
}

std::string gyro_unit_text(const Finding& finding) {
  if (finding.measured == 0.0) return "the gyro gives rates beyond 40 rad/s: is it in deg/s?";
  const bool degrees = std::abs(finding.measured) > 1.0;
  return "the gyro turns " + times_text(finding.measured) + " as fast as the " + turner(finding.other) +
         (degrees ? ": is it in deg/s?" : ": was it converted from deg/s twice?");
}

struct SpeedUnit {
  double per_m_s;
  const char* name;
};

std::string wheel_unit_text(const Finding& finding) {
  if (finding.measured == 0.0) {
    return "the wheels give speeds beyond 20 m/s or 40 rad/s: are they in mm/s, cm/s or deg/s?";
  }
  constexpr std::array<SpeedUnit, 4> kUnits{
      {{3.6, "km/h"}, {1000.0, "mm/s"}, {100.0, "cm/s"}, {3.2808, "ft/s"}}};
  const char* best = nullptr;
  double nearest = 0.2;
  for (const SpeedUnit& unit : kUnits) {
    const double off = std::abs(finding.measured / unit.per_m_s - 1.0);
    if (off < nearest) best = unit.name;
    if (off < nearest) nearest = off;
  }
  const std::string seen = "the wheels go " + times_text(finding.measured) + " as fast as the scans: ";
  return seen + (best != nullptr ? "are they in " + std::string(best) + "?"
                                 : "are unit and radius right? " + general(finding.remedy[0], 3) +
                                       " times their speed would fit");
}

std::string wheel_turn_unit_text(const Finding& finding) {
  const bool degrees = std::abs(finding.measured) > 1.0;
  return "the wheels turn " + times_text(finding.measured) + " as fast as the scans: " +
         (degrees ? "is their turn rate in deg/s?" : "was their turn rate converted from deg/s twice?");
}

std::string lidar_yaw_text(const Finding& finding) {
  return "the scans move " + fixed(std::abs(finding.measured), 0) + " deg to the " +
         (finding.measured > 0.0 ? "left" : "right") +
         " of where the wheels go: " + would_fit_text("lidar.rpy_deg", finding.remedy);
}

std::string clock_hint(double difference_s) {
  const double size = std::abs(difference_s);
  constexpr double kYearsS = 1e9;
  if (size > kYearsS) {
    return difference_s < 0.0 ? "; it counts from its own start, not from 1970"
                              : "; the other counts from its own start";
  }
  if (std::abs(size - 18.0) < 0.6) return "; GPS time is 18 s ahead of UTC";
  if (std::abs(size - 37.0) < 0.6) return "; TAI is 37 s ahead of UTC";
  constexpr double kZoneS = 1800.0;
  const double zones = std::round(size / kZoneS);
  const bool is_zone = zones >= 1.0 && size <= 14.0 * 3600.0 && std::abs(size - zones * kZoneS) < 60.0;
  return is_zone ? "; is it another time zone?" : "";
}

std::string clock_text(const Finding& finding) {
  const bool in_common = finding.kind != Contradiction::kNoOverlap;
  const std::string lead =
      std::string("the clock of the ") + noun(finding.sensor) + " is " + (in_common ? "" : "about ");
  const char* direction = finding.measured < 0.0 ? " behind" : " ahead of";
  const bool lidar_alone = !in_common && finding.sensor == CheckedSensor::kLidar;
  const std::string other =
      lidar_alone ? " those of the other sensors" : std::string(" that of the ") + noun(finding.other);
  return lead + clock_difference_text(finding.measured) + direction + other +
         (in_common
              ? std::string(", as their turns show")
              : ": they have no time in common, " + clock_difference_text(finding.evidence) + " apart") +
         clock_hint(finding.measured);
}

}  // namespace

std::string clock_difference_text(double difference_s) {
  const double size = std::abs(difference_s);
  constexpr double kDayS = 86'400.0;
  if (size < 120.0) return fixed(size, 1) + " s";
  if (size >= 10.0 * kDayS) return fixed(size / kDayS, 0) + " days";
  const auto whole = static_cast<long long>(std::llround(size));
  const std::string rest = std::to_string(whole / 60 % 60) + " min " + std::to_string(whole % 60) + " s";
  return whole < 3600 ? rest : std::to_string(whole / 3600) + " h " + rest;
}

std::string finding_text(const Finding& finding) {
  switch (finding.kind) {
    case Contradiction::kImuMount:
      return gravity_text(finding);
    case Contradiction::kAccelUnit:
      return "gravity is " + fixed(finding.measured, 2) +
             " instead of 9.81: is the acceleration in g, not in m/s^2?";
    case Contradiction::kAccelNegated:
      return "gravity points up, but the gyro turns the right way: are the accelerations negated?";
    case Contradiction::kGyroUnit:
      return gyro_unit_text(finding);
    case Contradiction::kGyroMirrored:
      return std::string("the gyro turns against the ") + turner(finding.other) +
             ": is its z axis negated, or are its axes left-handed?";
    case Contradiction::kLidarMirrored:
      return "the scans turn against gyro and wheels: is the lidar upside down (180 deg more of roll)?";
    case Contradiction::kLidarYaw:
      return lidar_yaw_text(finding);
    case Contradiction::kWheelsReversed:
      return "the wheels go backwards while the scans go forwards: negate their speed";
    case Contradiction::kWheelsOrLidar:
      return "the wheels go backwards while the scans go forwards: negate them, or " +
             would_fit_text("lidar.rpy_deg", finding.remedy);
    case Contradiction::kWheelUnit:
      return wheel_unit_text(finding);
    case Contradiction::kWheelTurnReversed:
      return "the wheels turn against the scans: negate their turn rate, or exchange left and right";
    case Contradiction::kWheelTurnUnit:
      return wheel_turn_unit_text(finding);
    case Contradiction::kBarometersSwapped:
      return "the base station's pressure moves by " + fixed(finding.measured, 0) +
             " Pa while the robot's stands: exchange barometer and base_barometer";
    case Contradiction::kClocksApart:
    case Contradiction::kNoOverlap:
      return clock_text(finding);
  }
  return {};
}

std::string left_out_text(const UsableSensors& usable) {
  std::string names;
  const auto add = [&names](bool used, std::string_view name) {
    if (!used) names += (names.empty() ? "" : " and ") + std::string(name);
  };
  add(usable.imu, "IMU");
  add(usable.wheels, "wheels");
  add(usable.barometers, "barometers");
  return names.empty() ? names : "not used: " + names;
}

}  // namespace isobar

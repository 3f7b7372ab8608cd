// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/unit_guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "core/plausibility.hpp"
#include "core/printable_text.hpp"
#include "core/samples.hpp"
#include "run/text/number_text.hpp"

namespace isobar::tools {
namespace {

struct KnownUnit {
  const char* name;
  double scale;
};

/// The chosen unit; nothing where none is chosen.
const KnownUnit* find_chosen(const std::string& chosen, const std::vector<KnownUnit>& units,
                             const char* option) {
  if (chosen.empty()) return nullptr;
  std::string names;
  for (const KnownUnit& unit : units) {
    if (chosen == unit.name) return &unit;
    names += (names.empty() ? "" : ", ") + std::string(unit.name);
  }
  throw UsageError(std::string(option) + ": must be one of " + names + " (got " + printable(chosen) + ")");
}

std::string rounded(double value) { return text::number_text(std::round(value * 1000.0) / 1000.0); }

}  // namespace

double median_of(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

UnitGuess guess_accel_unit(const std::string& chosen, std::vector<double> norms) {
  static const std::vector<KnownUnit> kUnits{{"m/s2", 1.0}, {"g", kGravity}, {"mg", kGravity / 1000.0}};
  if (const KnownUnit* unit = find_chosen(chosen, kUnits, "--accel-unit")) return {unit->scale, unit->name};
  const double median = median_of(norms);
  // A robot's specific force stays near one g for most of the time.
  constexpr double kMostOff = 0.35;
  for (const KnownUnit& unit : kUnits) {
    if (std::abs(median * unit.scale / kGravity - 1.0) > kMostOff) continue;
    return {unit.scale, unit.scale == 1.0 ? unit.name : std::string(unit.name) + ", converted"};
  }
  return {1.0, "m/s2? its median is " + rounded(median) + ", which is no gravity in m/s2, g or mg", false};
}

UnitGuess guess_gyro_unit(const std::string& chosen, std::vector<double> rates, double attitude_turn,
                          double rate_turn) {
  static const std::vector<KnownUnit> kUnits{{"rad/s", 1.0}, {"deg/s", kRadPerDeg}};
  if (const KnownUnit* unit = find_chosen(chosen, kUnits, "--gyro-unit")) return {unit->scale, unit->name};
  if (rates.empty()) return {1.0, "rad/s"};
  const double fastest = *std::max_element(rates.begin(), rates.end());
  UnitGuess degrees{kRadPerDeg, "deg/s, converted"};
  if (fastest > std::sqrt(3.0) * kPlausibleGyroRadS.highest) return degrees;
  // The IMU's own attitude turns as its rates say: 57 times less where they are in degrees.
  constexpr double kLeastTurnRad = 0.3;
  if (attitude_turn > kLeastTurnRad) {
    return rate_turn * kRadPerDeg > attitude_turn / 4.0 ? degrees
                                                        : UnitGuess{1.0, "rad/s, as its attitude turns"};
  }
  return {1.0, "rad/s"};
}

UnitGuess guess_pressure_unit(const std::string& chosen, std::vector<double> values) {
  static const std::vector<KnownUnit> kUnits{{"Pa", 1.0}, {"hPa", 100.0}, {"kPa", 1000.0}};
  if (const KnownUnit* unit = find_chosen(chosen, kUnits, "--pressure-unit"))
    return {unit->scale, unit->name};
  const double median = median_of(values);
  for (const KnownUnit& unit : kUnits) {
    if (!kGroundPressurePa.holds(median * unit.scale)) continue;
    return {unit.scale, unit.scale == 1.0 ? unit.name : std::string(unit.name) + ", converted"};
  }
  return {1.0, "its median is " + rounded(median) + ", which is no air pressure in Pa, hPa or kPa", false};
}

}  // namespace isobar::tools

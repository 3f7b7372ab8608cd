// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/atmosphere.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/samples.hpp"

namespace isobar::simulation {

namespace {

constexpr double kDryAirGasJKgK = 287.05;  // specific gas constant
constexpr double kAirKgM3 = 1.2;           // density of air

/// Door pulse: a half sine wave, then one of opposite sign and half the amplitude. `duration_s`: sum of both.
void add_pulse(std::vector<double>& pressure, double start_s, double duration_s, double peak_pa) {
  const auto first = static_cast<std::size_t>(std::max(0.0, start_s / SplineGrid::kStepS));
  for (std::size_t i = first; i < pressure.size(); ++i) {
    const double phase = (SplineGrid::kStepS * static_cast<double>(i) - start_s) / duration_s;
    if (phase >= 1.0) break;
    const double wave = phase < 0.6 ? std::sin(std::numbers::pi * phase / 0.6)
                                    : -0.5 * std::sin(std::numbers::pi * (phase - 0.6) / 0.4);
    pressure[i] += peak_pa * wave;
  }
}

/// Dynamic pressure of driving: half the density of air times the speed squared.
double dynamic_pressure_pa(const std::vector<RawPose>& raw, std::size_t i) {
  if (i == 0) return 0.0;
  const double speed =
      std::hypot(raw[i].x_m - raw[i - 1].x_m, raw[i].y_m - raw[i - 1].y_m) / SplineGrid::kStepS;
  return 0.5 * kAirKgM3 * speed * speed;
}

/// A pressure step at every change of zone, behind a low-pass of 1.5 s: after a door opens, the pressure
/// settles within a second or two.
void add_zones(std::vector<double>& pressure, const AirZones& air, double sigma_pa, Random& random) {
  if (air.zone.empty() || (sigma_pa <= 0.0 && !air.zones)) return;
  // The paper's runs show steps of 2 to 35 cm: 0.2 to 4 Pa.
  const std::uint64_t seed = random.next();
  double offset = 0.0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    Random of_zone(seed, "zone", static_cast<std::uint64_t>(air.zone[std::min(i, air.zone.size() - 1)]));
    const double wanted = air.zones ? of_zone.sign() * of_zone.uniform(air.zones->low_pa, air.zones->high_pa)
                                    : std::clamp(of_zone.normal(sigma_pa), -2.0, 2.0);
    offset = i == 0 ? wanted : offset + (wanted - offset) * SplineGrid::kStepS / 1.5;
    pressure[i] += offset;
  }
}

/// Gusts of wind at both ports, each with its own turbulence. Turbulence intensity (rms over mean) of 0.3 and
/// an integral scale of some tens of metres are usual a metre above open ground (Stull 1988, "An Introduction
/// to Boundary Layer Meteorology").
void add_wind(std::vector<double>& pressure, double mean_m_s, double share, Random random) {
  constexpr double kIntensity = 0.3;
  constexpr double kScaleM = 25.0;
  GaussMarkov turbulence(kIntensity * mean_m_s, kScaleM / mean_m_s, random);
  double wind_m_s = mean_m_s;
  for (double& pa : pressure) {
    // A low-pass of 0.5 s: eddies smaller than a few metres average out over a housing and its tube.
    const double now_m_s = std::max(0.0, mean_m_s + turbulence.step(SplineGrid::kStepS));
    wind_m_s += (now_m_s - wind_m_s) * SplineGrid::kStepS / 0.5;
    pa += share * 0.5 * kAirKgM3 * wind_m_s * wind_m_s;
  }
}

/// Door pulses at random times: at the robot, and later and weaker at the base station, which is farther away.
void add_door_pulses(const AirZones& air, double typical_pa, std::vector<double>& robot,
                     std::vector<double>& base, Random& random) {
  const double mean_s = 1.0 / air.door_pulses_1_s;
  const double end_s = SplineGrid::kStepS * static_cast<double>(robot.size());
  for (double t = random.exponential(mean_s); t < end_s; t += random.exponential(mean_s)) {
    const double sign = random.sign();
    const double size = air.pulses ? random.uniform(air.pulses->low_pa, air.pulses->high_pa)
                                   : typical_pa * random.uniform(0.4, 1.6);
    const double duration_s = random.uniform(0.5, 2.0);
    add_pulse(robot, t, duration_s, sign * size);
    add_pulse(base, t + 0.05, duration_s, sign * size * random.uniform(0.0, 0.6));
  }
}

}  // namespace

AirErrors AirErrors::draw(Random random) {
  AirErrors errors;
  // Weather fronts change the pressure by several hPa in three hours: here by 1 to 4 hPa, up or down.
  errors.ramp_pa_s = random.sign() * random.uniform(100.0, 400.0) / 10'800.0;
  errors.walk_pa_sqrt_s = random.uniform(0.05, 0.2);
  errors.turbulence_pa = random.uniform(0.3, 1.0);
  // Indoors, a few metres apart: the residual of the paper's static pair of sensors after filtering (0.7 cm).
  errors.local_turbulence_pa = random.uniform(0.08, 0.16);
  errors.zone_sigma_pa = random.uniform(0.3, 1.0);
  errors.pulse_pa = random.uniform(3.0, 15.0);
  return errors;
}

Atmosphere::Atmosphere(const Scenario& scenario, const AirErrors& errors, Random random)
    : air_temperature_k_(scenario.air_temperature_c + 273.15), base_height_m_(scenario.base_height_m) {
  const std::size_t samples = scenario.raw.size();
  std::vector<double> common(samples);
  std::vector<double> robot(samples, 0.0);
  std::vector<double> base(samples, 0.0);
  GaussMarkov turbulence(errors.turbulence_pa, 60.0, Random(random.next()));
  GaussMarkov at_robot(errors.local_turbulence_pa, 4.0, Random(random.next()));
  GaussMarkov at_base(errors.local_turbulence_pa, 4.0, Random(random.next()));
  double walk = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    walk += random.normal(errors.walk_pa_sqrt_s * std::sqrt(SplineGrid::kStepS));
    const double time_s = SplineGrid::kStepS * static_cast<double>(i);
    common[i] = scenario.start_pressure_pa + errors.ramp_pa_s * SplineGrid::kStepS * static_cast<double>(i) +
                walk + turbulence.step(SplineGrid::kStepS) + scenario.air.common_ramp.at(time_s) +
                scenario.air.common_gust.at(time_s);
    robot[i] = at_robot.step(SplineGrid::kStepS);
    base[i] = at_base.step(SplineGrid::kStepS);
    const double climb_m_s =
        i == 0 ? 0.0 : (scenario.raw[i].z_m - scenario.raw[i - 1].z_m) / SplineGrid::kStepS;
    robot[i] += scenario.air.piston_pa_s_m * (errors.pulse_pa > 0.0 ? climb_m_s : 0.0);
    robot[i] += scenario.air.port_coefficient * dynamic_pressure_pa(scenario.raw, i);
  }
  add_zones(robot, scenario.air, errors.zone_sigma_pa, random);
  if (scenario.air.door_pulses_1_s > 0.0 && errors.pulse_pa > 0.0) {
    add_door_pulses(scenario.air, errors.pulse_pa, robot, base, random);
  }
  if (scenario.air.wind_m_s > 0.0) {
    add_wind(robot, scenario.air.wind_m_s, scenario.air.port_wind_share, Random(random.next()));
    add_wind(base, scenario.air.wind_m_s, scenario.air.base_wind_share, Random(random.next()));
  }
  common_pa_ = Channel(std::move(common));
  robot_pa_ = Channel(std::move(robot));
  base_pa_ = Channel(std::move(base));
}

// The paper's hypsometric equation for an isothermal column of air, solved for p1.
double Atmosphere::column(double pressure_pa, double height_m) const {
  return pressure_pa * std::exp(-kGravity * height_m / (kDryAirGasJKgK * air_temperature_k_));
}

double Atmosphere::robot_pa(double time_s, double height_m) const {
  return column(common_pa_.at(time_s), height_m) + robot_pa_.at(time_s);
}

double Atmosphere::base_pa(double time_s) const {
  return column(common_pa_.at(time_s), base_height_m_) + base_pa_.at(time_s);
}

}  // namespace isobar::simulation

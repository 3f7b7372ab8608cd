// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/sensitivity_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "simulation/atmosphere.hpp"
#include "simulation/barometer_model.hpp"

namespace isobar::simulation {

namespace {

constexpr double kLiftS = 1.0;  // duration of a lift by hand
constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

/// Noise and resolution of a Setra 278 with a 16-bit converter.
///
/// Data sheet (sold as Campbell CS100): resolution 0.01 hPa, repeatability 0.03 hPa, response < 100 ms, 0 to
/// 2.5 V for 500 hPa, hence 20 Pa/mV: noise of the converter and the wiring dominates that of the sensor. The
/// sum follows from the paper: a median error of 2.36 cm after its filter is 3.5 cm or 0.41 Pa rms (median of
/// |x| = 0.674 sigma). A low-pass of 1 s at 32 Hz leaves sqrt(K / (2 - K)) = 0.124 of a pair's white noise, K
/// = 1 / 33: hence 3.3 Pa for the pair, 2.35 Pa per sensor, 0.12 mV. Samples are rounded to 1 Pa.
constexpr double kCeramicNoisePa = 2.35;
constexpr double kCeramicResolutionPa = 1.0;

BarometerErrors draw_ceramic(Random random) {
  BarometerErrors errors;
  errors.offset_pa = random.normal(15.0);  // accuracy 0.5 hPa at 20 degC (maximum error)
  errors.scale = random.normal(1e-4);      // linearity 0.4 hPa over 500 hPa
  errors.noise_pa = kCeramicNoisePa;
  errors.flicker_pa = random.uniform(0.05, 0.15);
  errors.warm_up_k = random.uniform(0.1, 0.5);  // supply current 3 mA: little self-heating
  errors.warm_up_tau_s = random.uniform(180.0, 420.0);
  errors.powered_for_s = random.uniform(300.0, 2400.0);
  errors.drift_pa_k = random.normal(1.0);  // 1 to 1.5 hPa between -20 and +50 degC
  errors.temperature_noise_k = 0.01;
  return errors;
}

BarometerErrors draw_dps310(Random random, bool standing, double noise_pa) {
  BarometerErrors errors = BarometerErrors::draw(random, standing);
  errors.noise_pa = noise_pa;
  return errors;
}

/// Times of the middles of the lifts [s]; sets the duration of the experiment.
std::vector<double> draw_moves(const RigRequest& request, Random random, double& duration_s) {
  std::vector<double> moves;
  double time_s = 0.0;
  for (int step = 0; step < request.steps; ++step) {
    time_s += request.dwell_s * random.uniform(0.8, 1.2);
    moves.push_back(time_s);
  }
  duration_s = time_s + request.dwell_s;
  return moves;
}

/// Raw poses of the lifted rig: only the height changes.
std::vector<RawPose> heights(const std::vector<double>& moves, double step_m, double duration_s) {
  std::vector<RawPose> raw(static_cast<std::size_t>(duration_s / SplineGrid::kStepS) + 10);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    for (const double move_s : moves) {
      const double share =
          std::clamp((SplineGrid::kStepS * static_cast<double>(i) - move_s) / kLiftS + 0.5, 0.0, 1.0);
      raw[i].z_m += step_m * 0.5 * (1.0 - std::cos(std::numbers::pi * share));
    }
  }
  return raw;
}

double rounded(double pressure_pa, double resolution_pa) {
  return resolution_pa > 0.0 ? resolution_pa * std::round(pressure_pa / resolution_pa) : pressure_pa;
}

/// One barometer of the experiment.
struct RigSensor {
  BarometerModel model;
  bool moved;  ///< on the rig that is lifted
  double resolution_pa;
  std::vector<PressureSample>& out;
  double phase_s;  ///< time of the first sample within the sampling interval
};

/// The four barometers of the experiment, which write to `run`.
std::vector<RigSensor> make_sensors(const RigRequest& request, RigRun& run) {
  const auto stream = [&](std::string_view name) { return Random(request.seed, name); };
  Random phase = stream("phases");
  const auto phase_s = [&] { return phase.uniform(0.0, 1.0 / BarometerModel::kRateHz); };
  const double noise_pa = request.dps310_noise_pa;
  std::vector<RigSensor> sensors;
  sensors.push_back({{draw_dps310(stream("moved"), false, noise_pa), stream("moved noise")},
                     true,
                     0.0,
                     run.dps310.moved,
                     phase_s()});
  sensors.push_back({{draw_dps310(stream("standing"), true, noise_pa), stream("standing noise")},
                     false,
                     0.0,
                     run.dps310.standing,
                     phase_s()});
  sensors.push_back({{draw_ceramic(stream("moved ceramic")), stream("moved ceramic noise")},
                     true,
                     kCeramicResolutionPa,
                     run.ceramic.moved,
                     phase_s()});
  sensors.push_back({{draw_ceramic(stream("standing ceramic")), stream("standing ceramic noise")},
                     false,
                     kCeramicResolutionPa,
                     run.ceramic.standing,
                     phase_s()});
  return sensors;
}

void record_samples(RigSensor& sensor, const Scenario& scenario, const Atmosphere& air, double duration_s) {
  for (double t = 0.1 + sensor.phase_s; t < duration_s; t += 1.0 / BarometerModel::kRateHz) {
    const double height_m = scenario.trajectory.at(t).p_world.z();
    const double true_pa = sensor.moved ? air.robot_pa(t, height_m) : air.base_pa(t);
    PressureSample sample = sensor.model.sample(t, true_pa, scenario.air_temperature_c);
    sample.pressure_pa = rounded(sample.pressure_pa, sensor.resolution_pa);
    sample.stamp_ns = kStartNs + std::llround(1e9 * t);
    sensor.out.push_back(sample);
  }
}

/// Air of one quiet room: no door pulses, no zones, and turbulence as given in the header.
AirErrors draw_room_air(Random random, double distance_m) {
  AirErrors errors = AirErrors::draw(random);
  errors.pulse_pa = 0.0;
  errors.zone_sigma_pa = 0.0;
  errors.local_turbulence_pa *= std::pow(std::min(1.0, distance_m / kFullTurbulenceM), 2.0 / 3.0);
  return errors;
}

}  // namespace

RigRun simulate_rig(const RigRequest& request) {
  const auto stream = [&](std::string_view name) { return Random(request.seed, name); };
  RigRun run;
  run.lift_s = kLiftS;
  double duration_s = 0.0;
  const std::vector<double> moves = draw_moves(request, stream("rig moves"), duration_s);
  for (const double move_s : moves) run.moves_ns.push_back(kStartNs + std::llround(1e9 * move_s));

  Scenario scenario;
  scenario.raw = heights(moves, request.step_m, duration_s);
  scenario.trajectory = Trajectory(scenario.raw);
  scenario.base_height_m = 0.0;
  run.air_temperature_c = scenario.air_temperature_c;
  const AirErrors air_errors = draw_room_air(stream("air errors"), request.distance_m);
  const Atmosphere air(scenario, air_errors, stream("air"));
  for (RigSensor& sensor : make_sensors(request, run)) record_samples(sensor, scenario, air, duration_s);
  return run;
}

}  // namespace isobar::simulation

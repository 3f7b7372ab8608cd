// SPDX-License-Identifier: BSD-3-Clause
// PriorEstimator: the Prior and the health of the barometers, from the state of the stage.
#include <algorithm>
#include <cmath>

#include "core/prior/prior_state.hpp"
#include "core/prior/wheel_noise.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Time constant with which a robot leaves the ventilated zone in which it started.
constexpr double kZoneTimeS = 30.0;
// A disturbance of the pressure for longer than this is a fault: a door lasts less.
constexpr double kWrongS = 1.5;

}  // namespace

HeightSource PriorEstimator::State::source(std::int64_t stamp_ns) const {
  if (reading_source == HeightSource::kNone) return HeightSource::kNone;
  if (altimeter.robot_lost(stamp_ns, config.height.barometer_timeout_s)) return HeightSource::kHeld;
  if (disturbed_for(config.height.barometer_timeout_s)) return HeightSource::kHeld;
  return reading_source;
}

Prior PriorEstimator::State::prior_at(const ImuSample& sample) const {
  Prior out;
  out.stamp_ns = sample.stamp_ns;
  out.T_odom_base.translation() = p_odom_base;
  fill_attitude(sample, out);
  fill_height(sample.stamp_ns, out);
  out.velocity_variance_m2_s2 = squared(config.attitude.free_velocity_sigma_m_s);
  if (attitude.started()) fill_wheels(sample.stamp_ns, out);
  out.wheel_turn_rad = wheels.turn_rad(sample.stamp_ns);
  out.up_accel_m_s2 = up_accel_m_s2;
  fill_altimeter(out);
  out.may_stand = attitude.started() && standstill.may_stand() && !height.ground_moves();
  out.standing_still = out.velocity_valid && standstill.standing() && !height.ground_moves();
  return out;
}

void PriorEstimator::State::fill_wheels(std::int64_t stamp_ns, Prior& out) const {
  out.velocity_valid = wheels.valid(stamp_ns);
  if (!out.velocity_valid) return;
  out.v_base_m_s = {wheels.last().vx_m_s, wheels.last().vy_m_s, 0.0};
  out.velocity_variance_m2_s2 =
      constant_variance(wheels.last().vx_variance_m2_s2, config.attitude.wheel_sigma_m_s) +
      squared(config.attitude.wheel_sigma_share) * out.v_base_m_s.squaredNorm();
}

void PriorEstimator::State::fill_altimeter(Prior& out) const {
  out.ground_moves = height.ground_moves();
  out.altimeter_m = altimeter_m;
  out.altimeter_variance_m2 = altimeter_variance_m2;
  out.altimeter_count = altimeter_count;
  out.altimeter_shift_m = altimeter_shift_m;
  out.base_air_m = base_air_m;
}

void PriorEstimator::State::fill_attitude(const ImuSample& sample, Prior& out) const {
  out.attitude_valid = attitude.started();
  if (attitude.started()) {
    out.T_odom_base.linear() = attitude.q_world_base().toRotationMatrix();
    out.accel_bias_m_s2 = attitude.accel_bias_m_s2();
    out.w_base_rad_s = attitude.rate_rad_s();
    out.roll_pitch_variance_rad2 = attitude.roll_pitch_variance_rad2();
    out.yaw_rate_variance_rad2_s2 = attitude.yaw_rate_variance_rad2_s2();
    out.yaw_bias_variance_rad2_s2 = attitude.gyro_bias_variance(2);
  } else {
    out.T_odom_base.linear() = rotation_about_z(yaw_before_rad);
    out.w_base_rad_s = R_base_imu * sample.gyro_rad_s;
    out.roll_pitch_variance_rad2 = 1.0;
    out.yaw_rate_variance_rad2_s2 = squared(config.attitude.gyro_bias_sigma_rad_s);
    out.yaw_bias_variance_rad2_s2 = out.yaw_rate_variance_rad2_s2;
  }
}

void PriorEstimator::State::fill_height(std::int64_t stamp_ns, Prior& out) const {
  if (!height.started()) return;
  out.height_m = height.z_m() - above_base(p_base_imu);
  const double on_for_s = std::max(0.0, seconds_between(height_start_ns, stamp_ns));
  const double warm_up_m =
      config.height.warm_up_sigma_m * -std::expm1(-on_for_s / config.height.warm_up_time_s);
  const double zone_m = config.height.zone_sigma_m * -std::expm1(-on_for_s / kZoneTimeS);
  out.height_variance_m2 = height.variance_m2() + squared(zone_m) +
                           squared(altimeter.scale_uncertainty() * out.height_m) + squared(warm_up_m);
  out.height_source = source(stamp_ns);
}

bool PriorEstimator::State::disturbed_for(double seconds) const {
  const DisturbanceJudge& judge = height.disturbance();
  return judge.unfelt() && seconds_between(judge.gated_since_ns(), now_ns()) > seconds;
}

BarometerFault PriorEstimator::State::robot_fault() const {
  const BarometerFault seen = altimeter.robot_fault();
  if (seen != BarometerFault::kOk && seen != BarometerFault::kSpiking) return seen;
  const DriftSuspect drifts = drift.suspect();
  if (drifts == DriftSuspect::kRobot || drifts == DriftSuspect::kUnknown) return BarometerFault::kDrifting;
  return disturbed_for(kWrongS) || height.pressure_faulty() ? BarometerFault::kWrong : seen;
}

BarometerFault PriorEstimator::State::base_fault(std::size_t station) const {
  const BarometerFault seen = altimeter.base_fault(station);
  if (seen != BarometerFault::kOk && seen != BarometerFault::kSpiking) return seen;
  const bool drifts = drift.suspect() == DriftSuspect::kBase || drift.suspect() == DriftSuspect::kUnknown;
  return drifts && station == altimeter.base_active() ? BarometerFault::kDrifting : seen;
}

// A robot that stands does not climb: what the altimeter does then is its own.
void PriorEstimator::State::watch_drift() {
  if (!wheels.valid(now_ns()) || !standstill.standing() || height.ground_moves()) {
    drift.restart();
    return;
  }
  drift.add({.stamp_ns = now_ns(),
             .residual_m = altimeter_m - altimeter_shift_m,
             .base_m = base_air_m,
             .base = reading_source == HeightSource::kDifferential});
}

void PriorEstimator::State::watch_barometers() {
  const auto update = [](BarometerFault& known, BarometerFault now, std::uint64_t& count) {
    if (now != known && now != BarometerFault::kOk && known == BarometerFault::kOk) ++count;
    known = now;
  };
  update(barometers.robot, robot_fault(), counters.robot_faults);
  for (std::size_t station = 0; station < barometers.base.size(); ++station) {
    update(barometers.base[station], base_fault(station), counters.base_faults);
    barometers.base_heard[station] =
        barometers.base_heard[station] || barometers.base[station] != BarometerFault::kOff;
  }
  for (std::size_t sensor = 0; sensor < barometers.thermometer_wrong.size(); ++sensor) {
    const bool wrong = altimeter.thermometer_wrong(sensor);
    if (wrong && !barometers.thermometer_wrong[sensor]) ++counters.thermometer_faults;
    barometers.thermometer_wrong[sensor] = wrong;
  }
  barometers.base_active = static_cast<std::uint8_t>(altimeter.base_active());
  barometers.base_usable = static_cast<std::uint8_t>(altimeter.base_usable_count());
  barometers.base_undecided = altimeter.base_undecided();
  if (height.started()) {
    barometers.height_bias_m = height.pressure_bias_m();
    barometers.height_bias_sd_m = std::sqrt(std::max(0.0, height.pressure_bias_variance_m2()));
  }
}

}  // namespace isobar

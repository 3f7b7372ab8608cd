// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/prior_estimator.hpp"

#include <cmath>

#include "core/prior/prior_state.hpp"
#include "core/prior/wheel_noise.hpp"

namespace isobar {
namespace {

// The sample after compensation with the sensor's calibration; counts samples outside of its range.
PressureSample compensated(PressureSample sample, SensorCompensation& compensation, std::uint64_t& outside,
                           std::uint64_t& without_temperature) {
  switch (compensation.apply(sample)) {
    case SensorCompensation::Result::kInside:
      break;
    case SensorCompensation::Result::kOutside:
      ++outside;
      break;
    case SensorCompensation::Result::kNoTemperature:
      ++without_temperature;
      break;
  }
  return sample;
}

}  // namespace

PriorEstimator::PriorEstimator(const PriorConfig& config) : state_(std::make_unique<State>(config)) {}
PriorEstimator::~PriorEstimator() = default;
PriorEstimator::PriorEstimator(PriorEstimator&&) noexcept = default;
PriorEstimator& PriorEstimator::operator=(PriorEstimator&&) noexcept = default;

void PriorEstimator::configure(const PriorConfig& config) {
  State& s = *state_;
  s.config.limits = config.limits;
  s.imu_gate.configure(config.limits);
  s.standstill.configure(config.standstill);
  s.wheels.configure(config.dead_reckoning);
}

const PriorCounters& PriorEstimator::counters() const { return state_->counters; }
const BarometerHealth& PriorEstimator::barometers() const { return state_->barometers; }

void PriorEstimator::resume(const HeightDatum& datum) {
  if (!datum.known) return;
  State& s = *state_;
  s.resumed = datum;
  // Level: the attitude is not known before the first samples, and the levers are short.
  s.altimeter.resume(datum, datum.height_m + s.config.p_base_port.z() + datum.offset_m);
}

HeightDatum PriorEstimator::height_datum() const {
  const State& s = *state_;
  HeightDatum datum;
  if (!s.height.started()) return s.resumed;
  datum.known = s.reading_source != HeightSource::kNone;
  datum.stamp_ns = s.now_ns();
  datum.climb_m_s = s.height.vz_m_s();
  datum.ground_moves = s.height.ground_moves();
  datum.height_m = s.height.z_m() - s.above_base(s.p_base_imu);
  datum.variance_m2 = s.height.variance_m2() + s.height.offset_variance_m2();
  datum.offset_m = s.height.offset_m();
  datum.step_open = s.height.step_open();
  s.altimeter.describe(datum);
  return datum;
}

bool PriorEstimator::add_imu(const ImuSample& sample, Prior& out) {
  State& s = *state_;
  const ImuStatus status = s.imu_gate.check(sample);
  if (status == ImuStatus::kBadValue) {
    ++s.counters.imu_bad_value;
    return false;
  }
  if (status == ImuStatus::kBadTime) {
    ++s.counters.imu_bad_time;
    return false;
  }
  ++s.counters.imu_accepted;
  const double dt_s = s.imu_gate.dt_s();
  const Eigen::Vector3d gyro = s.R_base_imu * sample.gyro_rad_s;
  const Eigen::Vector3d force = s.R_base_imu * sample.accel_m_s2;
  const bool gap = status == ImuStatus::kGap;
  if (gap) ++s.counters.imu_gaps;
  if (status == ImuStatus::kRestart) {
    ++s.counters.imu_restarts;
    s.restart_clock(dt_s);
  } else if (dt_s > 0.0) {
    if (s.attitude.started()) {
      const bool moved_before = s.height.ground_moves();
      s.step(gyro, force, dt_s, gap);
      if (s.height.ground_moves() && !moved_before) ++s.counters.moving_ground;
      s.use_device_attitude(sample, gyro, dt_s);
    } else {
      s.align(gyro, force, gap ? 0.0 : dt_s);
    }
  }
  s.gyro_before = gyro;
  s.altimeter.set_time(sample.stamp_ns);
  s.watch_barometers();
  out = s.prior_at(sample);
  return true;
}

void PriorEstimator::add_pressure(const PressureSample& measured) {
  State& s = *state_;
  if (s.bad_stamp(measured.stamp_ns)) {
    ++s.counters.pressure_bad_time;
    return;
  }
  const PressureSample sample = compensated(measured, s.compensation, s.counters.pressure_outside_calibration,
                                            s.counters.pressure_without_temperature);
  AltimeterReading reading;
  s.altimeter.set_witness(s.witness_m());
  const double lever_m = s.above_base(s.config.p_base_port - s.p_base_imu);
  s.altimeter.set_climb(s.climbed_m + lever_m);
  switch (s.altimeter.add_robot(sample, reading)) {
    case PressureStatus::kBadValue:
      ++s.counters.pressure_bad_value;
      return;
    case PressureStatus::kStale:
    case PressureStatus::kBadTime:
      ++s.counters.pressure_bad_time;
      return;
    case PressureStatus::kRepeated:
      ++s.counters.pressure_repeated;
      return;
    case PressureStatus::kAccepted:
      break;
  }
  ++s.counters.pressure_accepted;
  if (reading.event == ReferenceEvent::kBaseLost) ++s.counters.base_lost;
  if (reading.event == ReferenceEvent::kBaseSwitched) ++s.counters.base_switched;
  s.reading_source = reading.source;
  if (!reading.complete) return;
  s.reading_m = reading.height_m;
  s.altimeter_m = reading.height_m + reading.climb_since_m - s.above_base(s.config.p_base_port);
  s.altimeter_variance_m2 = reading.noise_variance_m2;
  s.base_air_m = reading.base_air_m;
  ++s.altimeter_count;
  if (reading.event == ReferenceEvent::kBaseReturned || reading.event == ReferenceEvent::kBaseSwitched) {
    s.altimeter_shift_m += reading.weather_shift_m;
  }
  s.watch_drift();
  if (!s.levelled() || !s.height.started()) return;
  // The filter extrapolates with its present speed: what the acceleration has changed since is added here.
  const double delay_s = seconds_between(reading.stamp_ns, s.now_ns());
  if (delay_s > 0.0) reading.height_m += reading.climb_since_m - s.height.vz_m_s() * delay_s;
  const PressureUse use = s.height.update_pressure(reading, lever_m, s.now_ns());
  if (use == PressureUse::kGated) ++s.counters.pressure_gated;
  if (use == PressureUse::kStep) ++s.counters.pressure_steps;
}

void PriorEstimator::add_base_pressure(const PressureSample& measured) {
  State& s = *state_;
  if (s.bad_stamp(measured.stamp_ns)) {
    ++s.counters.base_bad_time;
    return;
  }
  const PressureSample sample =
      measured.station == 0 ? compensated(measured, s.base_compensation, s.counters.base_outside_calibration,
                                          s.counters.base_without_temperature)
                            : measured;
  switch (s.altimeter.add_base(sample)) {
    case PressureStatus::kBadValue:
      ++s.counters.base_bad_value;
      return;
    case PressureStatus::kBadTime:
      ++s.counters.base_bad_time;
      return;
    case PressureStatus::kStale:
      ++s.counters.base_stale;
      return;
    case PressureStatus::kRepeated:
      ++s.counters.base_repeated;
      return;
    case PressureStatus::kAccepted:
      ++s.counters.base_accepted;
      return;
  }
}

void PriorEstimator::add_wheel(const WheelSample& measured) {
  State& s = *state_;
  WheelSample sample = measured;
  const bool believed = keep_believed_variances(sample);
  if (s.bad_stamp(sample.stamp_ns)) {
    ++s.counters.wheel_bad_time;
    return;
  }
  switch (s.wheels.add(sample)) {
    case WheelStatus::kBadValue:
      ++s.counters.wheel_bad_value;
      return;
    case WheelStatus::kBadTime:
      ++s.counters.wheel_bad_time;
      return;
    case WheelStatus::kAccepted:
      break;
  }
  ++s.counters.wheel_accepted;
  s.counters.wheel_bad_variance += believed ? 0 : 1;
  s.new_wheels = true;
  s.standstill.add_wheel(std::hypot(sample.vx_m_s, sample.vy_m_s), sample.wz_rad_s);
}

}  // namespace isobar

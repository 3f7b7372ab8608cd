// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/prior_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/altitude/stamp.hpp"
#include "core/prior/attitude_filter.hpp"
#include "core/prior/dead_reckoning.hpp"
#include "core/prior/height_filter.hpp"
#include "core/prior/imu_gate.hpp"
#include "core/prior/imu_noise.hpp"
#include "core/prior/rotation.hpp"
#include "core/prior/standstill.hpp"
#include "core/squared.hpp"

namespace isobar {
namespace {

// Bounded-velocity updates of a platform without wheels come this often.
constexpr double kBoundedUpdateS = 0.1;
// Wheels constrain the climb this often at most: their error is correlated over seconds anyway.
constexpr double kClimbUpdateS = 0.04;
// Up to this long a constant rate bridges a gap of the IMU; beyond, only the wheels' turn rate is believed.
constexpr double kConstantRateS = 0.3;
// What a robot may have turned unseen, 1 sigma [rad/s], at most [rad].
constexpr double kUnseenRate = 0.2;
constexpr double kUnseenTurn = 0.3;
// Roll and pitch from the first accelerations of a robot that may be moving [rad].
constexpr double kStartSigmaRad = 0.02;
// A robot's mean specific force over the start is gravity within a third: anything else is another unit (g)
// or a broken sensor, and would put the map on its side.
constexpr double kLeastGravity = 6.5;
constexpr double kMostGravity = 13.0;
// Vertical speed at the start of a platform on wheels, and of one that hangs [m/s].
constexpr double kStartClimbOnWheels = 0.05;
constexpr double kStartClimbHanging = 0.3;
// Within this a robot may have left the ventilated zone in which it started.
constexpr double kZoneTimeS = 30.0;
// A pressure that is no height for longer than a door is a fault.
constexpr double kWrongS = 1.5;
// The attitude of the IMU's own filter as a rate is believed within this of the gyro [rad/s].
constexpr double kDeviceRateTolerance = 0.1;
constexpr double kDeviceRateSigma = 0.01;
constexpr double kQuaternionTolerance = 0.05;

/// The sample as the calibrated sensor would have measured it; what is not as it was calibrated is counted.
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

struct PriorEstimator::State {
  explicit State(const PriorConfig& c)
      : config(c),
        R_base_imu(c.T_base_imu.linear()),
        q_base_imu(R_base_imu),
        p_base_imu(c.T_base_imu.translation()),
        imu_gate(c.limits),
        attitude(c.attitude, p_base_imu),
        standstill(c.standstill),
        wheels(c.dead_reckoning),
        compensation(c.compensation),
        base_compensation(c.base_compensation),
        altimeter(c.altimeter),
        height(c.height) {}

  PriorConfig config;
  PriorCounters counters;
  BarometerHealth barometers;
  Eigen::Matrix3d R_base_imu;
  Eigen::Quaterniond q_base_imu;
  Eigen::Vector3d p_base_imu;

  ImuGate imu_gate;
  ImuNoise noise;
  AttitudeFilter attitude;
  StandstillDetector standstill;
  WheelOdometer wheels;
  SensorCompensation compensation;
  SensorCompensation base_compensation;
  DifferentialAltimeter altimeter;
  HeightFilter height;

  // Start of the attitude: specific force summed in the axes of the newest sample.
  Eigen::Vector3d start_force_sum = Eigen::Vector3d::Zero();
  double start_elapsed_s = 0.0;
  int start_samples = 0;
  double yaw_before_rad = 0.0;

  Eigen::Vector3d gyro_before = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_device_before = Eigen::Quaterniond::Identity();
  bool has_device_before = false;
  double since_device_s = 0.0;
  Eigen::Vector3d device_bias_sum = Eigen::Vector3d::Zero();

  Eigen::Vector3d p_odom_base = Eigen::Vector3d::Zero();
  bool new_wheels = false;
  double since_bounded_s = 0.0;
  double since_climb_s = 0.0;
  double climb_integral_m = 0.0;
  double forward_integral_m = 0.0;

  HeightSource reading_source = HeightSource::kNone;
  std::int64_t height_start_ns = 0;

  void align(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s);
  void restart_alignment();
  void bridge_gap(const Eigen::Vector3d& gyro, double dt_s);
  void restart_clock(double dt_s);
  void move(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s, bool gap);
  void use_device_attitude(const ImuSample& sample, const Eigen::Vector3d& gyro, double dt_s);
  void use_standstill(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s, bool on_wheels);
  void use_wheels(std::int64_t stamp_ns, double dt_s, bool on_wheels);
  void use_climb(double dt_s, bool on_wheels, bool pressure_lost);
  void fill(const ImuSample& sample, Prior& out) const;
  void watch_barometers();
  [[nodiscard]] BarometerFault robot_fault() const;
  [[nodiscard]] bool disturbed_for(double seconds) const;
  [[nodiscard]] HeightSource source(std::int64_t stamp_ns) const;
  [[nodiscard]] bool bad_stamp(std::int64_t stamp_ns) const {
    if (!plausible_stamp(stamp_ns)) return true;
    return imu_gate.started() && seconds_between(imu_gate.stamp_ns(), stamp_ns) > config.limits.max_ahead_s;
  }
  /// Height of the pressure port as the wheels have it [m]; NaN where they cannot have it.
  [[nodiscard]] double witness_m() const {
    const bool known = attitude.started() && wheels.valid(imu_gate.stamp_ns()) && !height.ground_moves();
    return known ? p_odom_base.z() + above_base(config.p_base_port)
                 : std::numeric_limits<double>::quiet_NaN();
  }
  /// Height of a point of base_link above base_link's origin.
  [[nodiscard]] double above_base(const Eigen::Vector3d& p_base) const {
    return (attitude.q_world_base() * p_base).z();
  }
};

void PriorEstimator::State::align(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s) {
  const Eigen::Vector3d turn = (gyro - attitude.gyro_bias_rad_s()) * dt_s;
  start_force_sum = rotation_of(turn).conjugate() * start_force_sum + force;
  start_elapsed_s += dt_s;
  ++start_samples;
  if (start_elapsed_s < config.attitude.start_time_s) return;
  const double mean_force_m_s2 = start_force_sum.norm() / start_samples;
  if (mean_force_m_s2 < kLeastGravity || mean_force_m_s2 > kMostGravity) {
    ++counters.imu_wrong_gravity;
    restart_alignment();
    return;
  }
  attitude.start(start_force_sum, yaw_before_rad, kStartSigmaRad);
  restart_alignment();
  const bool on_wheels = wheels.valid(imu_gate.stamp_ns());
  if (!height.started()) {
    height_start_ns = imu_gate.stamp_ns();
    height.start(above_base(p_base_imu), on_wheels ? kStartClimbOnWheels : kStartClimbHanging);
  }
}

void PriorEstimator::State::restart_alignment() {
  start_force_sum.setZero();
  start_elapsed_s = 0.0;
  start_samples = 0;
}

void PriorEstimator::State::bridge_gap(const Eigen::Vector3d& gyro, double dt_s) {
  // The rate before holds for the beginning, the rate now for the end; between them the wheels' turn rate, if
  // any.
  const double edge_s = std::min(0.5 * dt_s, kConstantRateS);
  Eigen::Vector3d turn = (gyro_before + gyro - 2.0 * attitude.gyro_bias_rad_s()) * edge_s;
  if (wheels.valid(imu_gate.stamp_ns())) turn.z() += wheels.last().wz_rad_s * (dt_s - 2.0 * edge_s);
  attitude.bridge(turn, dt_s, std::min(kUnseenRate * dt_s, kUnseenTurn));
  standstill.restart();
  noise.restart();
  height.bridge(dt_s);
}

void PriorEstimator::State::restart_clock(double dt_s) {
  yaw_before_rad = attitude.started() ? yaw_of(attitude.q_world_base()) : yaw_before_rad;
  attitude.stop();
  standstill.restart();
  noise.restart();
  altimeter.restart_clock();
  wheels = WheelOdometer(config.dead_reckoning);
  if (height.started()) height.bridge(dt_s);
  restart_alignment();
  has_device_before = false;
}

void PriorEstimator::State::use_device_attitude(const ImuSample& sample, const Eigen::Vector3d& gyro,
                                                double dt_s) {
  const bool usable = config.attitude.use_imu_attitude && sample.has_attitude &&
                      std::abs(sample.q_world_imu.norm() - 1.0) <= kQuaternionTolerance;
  if (!usable) {
    has_device_before = false;
    return;
  }
  const Eigen::Quaterniond q_device = (sample.q_world_imu.normalized() * q_base_imu.conjugate()).normalized();
  if (has_device_before) {
    const Eigen::Vector3d rate = angle_of(q_device_before.conjugate() * q_device) / dt_s;
    if ((rate - gyro + attitude.gyro_bias_rad_s()).cwiseAbs().maxCoeff() < kDeviceRateTolerance) {
      device_bias_sum += (gyro - rate) * dt_s;
      since_device_s += dt_s;
    }
  }
  q_device_before = q_device;
  has_device_before = true;
  if (since_device_s < kBoundedUpdateS) return;
  attitude.update_up_direction(q_device.conjugate() * Eigen::Vector3d::UnitZ(), since_device_s);
  attitude.update_gyro_bias(device_bias_sum / since_device_s, kDeviceRateSigma);
  device_bias_sum.setZero();
  since_device_s = 0.0;
}

void PriorEstimator::State::use_standstill(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force,
                                           double dt_s, bool on_wheels) {
  const double bias_sigma = std::sqrt(std::max(
      {attitude.gyro_bias_variance(0), attitude.gyro_bias_variance(1), attitude.gyro_bias_variance(2)}));
  standstill.add_imu(gyro, attitude.gyro_bias_rad_s(), bias_sigma, force, dt_s);
  // A hanging platform that seems to stand may turn slowly and evenly: without wheels the gyro is not its own
  // witness.
  if (!standstill.take_window() || !on_wheels) return;
  attitude.update_zero_rate(standstill.mean_gyro(), standstill.window_s(),
                            standstill.gyro_variance_of_mean());
}

void PriorEstimator::State::use_wheels(std::int64_t stamp_ns, double dt_s, bool on_wheels) {
  if (on_wheels && new_wheels) {
    const double wheel_dt_s = std::max(wheels.interval_s(), dt_s);
    attitude.update_wheels(wheels.last().vx_m_s, wheels.last().vy_m_s,
                           std::min(wheel_dt_s, config.dead_reckoning.wheel_timeout_s),
                           !height.ground_moves());
    new_wheels = false;
  }
  since_bounded_s = on_wheels ? 0.0 : since_bounded_s + dt_s;
  if (since_bounded_s >= kBoundedUpdateS) {
    attitude.update_bounded_velocity(since_bounded_s);
    since_bounded_s = 0.0;
  }
  const Eigen::Vector2d rolled = wheels.take_displacement(stamp_ns);
  const Eigen::Quaterniond half_back = rotation_of(attitude.rate_rad_s() * (-0.5 * dt_s));
  p_odom_base += attitude.q_world_base() * half_back * Eigen::Vector3d(rolled.x(), rolled.y(), 0.0);
}

void PriorEstimator::State::use_climb(double dt_s, bool on_wheels, bool pressure_lost) {
  if (!on_wheels && !pressure_lost) {
    since_climb_s = climb_integral_m = forward_integral_m = 0.0;
    return;
  }
  since_climb_s += dt_s;
  if (on_wheels) {
    const Eigen::Vector3d v_base(wheels.last().vx_m_s, wheels.last().vy_m_s, 0.0);
    const Eigen::Vector3d v_imu = v_base + attitude.rate_rad_s().cross(p_base_imu);
    const Eigen::Vector3d forward = attitude.q_world_base() * Eigen::Vector3d::UnitX();
    climb_integral_m += above_base(v_imu) * dt_s;
    forward_integral_m += v_base.x() * std::hypot(forward.x(), forward.y()) * dt_s;
  }
  if (since_climb_s < kClimbUpdateS) return;
  if (on_wheels) {
    height.update_climb(climb_integral_m / since_climb_s, forward_integral_m / since_climb_s, since_climb_s,
                        attitude.roll_pitch_variance_rad2());
  } else {
    height.update_bounded_speed(since_climb_s);
  }
  since_climb_s = climb_integral_m = forward_integral_m = 0.0;
}

void PriorEstimator::State::move(const Eigen::Vector3d& gyro, const Eigen::Vector3d& force, double dt_s,
                                 bool gap) {
  const std::int64_t stamp_ns = imu_gate.stamp_ns();
  const bool on_wheels = wheels.valid(stamp_ns);
  if (gap) {
    bridge_gap(gyro, dt_s);
  } else {
    noise.add_sample(gyro, force, dt_s);
    attitude.predict(gyro, force, dt_s, noise.gyro_variance(), noise.accel_variance());
    // Without the attitude filter's accelerometer bias, which still moves: the height filter has its own.
    const double up_accel = above_base(force) - kGravity;
    noise.add_up_accel(up_accel);
    height.predict(up_accel, dt_s, noise.up_accel_density(dt_s));
    use_standstill(gyro, force, dt_s, on_wheels);
  }
  use_wheels(stamp_ns, dt_s, on_wheels);
  const bool pressure_lost = altimeter.robot_lost(stamp_ns, config.height.barometer_timeout_s);
  if (!gap) use_climb(dt_s, on_wheels, pressure_lost);
}

HeightSource PriorEstimator::State::source(std::int64_t stamp_ns) const {
  if (reading_source == HeightSource::kNone) return HeightSource::kNone;
  if (altimeter.robot_lost(stamp_ns, config.height.barometer_timeout_s)) return HeightSource::kHeld;
  if (disturbed_for(config.height.barometer_timeout_s)) return HeightSource::kHeld;
  return reading_source;
}

void PriorEstimator::State::fill(const ImuSample& sample, Prior& out) const {
  out = Prior{};
  out.stamp_ns = sample.stamp_ns;
  const bool on_wheels = wheels.valid(sample.stamp_ns);
  out.T_odom_base.translation() = p_odom_base;
  out.attitude_valid = attitude.started();
  if (attitude.started()) {
    out.T_odom_base.linear() = attitude.q_world_base().toRotationMatrix();
    out.w_base_rad_s = attitude.rate_rad_s();
    out.roll_pitch_variance_rad2 = attitude.roll_pitch_variance_rad2();
    out.yaw_rate_variance_rad2_s2 = attitude.yaw_rate_variance();
  } else {
    out.T_odom_base.linear() = Eigen::AngleAxisd(yaw_before_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    out.w_base_rad_s = R_base_imu * sample.gyro_rad_s;
    out.roll_pitch_variance_rad2 = 1.0;
    out.yaw_rate_variance_rad2_s2 = squared(config.attitude.gyro_bias_sigma_rad_s);
  }
  if (height.started()) {
    out.height_m = height.z_m() - above_base(p_base_imu);
    const double on_for_s = std::max(0.0, seconds_between(height_start_ns, sample.stamp_ns));
    const double warm_up_m =
        config.height.warm_up_sigma_m * -std::expm1(-on_for_s / config.height.warm_up_time_s);
    const double zone_m = config.height.zone_sigma_m * -std::expm1(-on_for_s / kZoneTimeS);
    out.height_variance_m2 = height.variance_m2() + squared(zone_m) +
                             squared(altimeter.scale_uncertainty() * out.height_m) + squared(warm_up_m);
  }
  out.height_source = height.started() ? source(sample.stamp_ns) : HeightSource::kNone;
  out.velocity_valid = on_wheels && attitude.started();
  out.velocity_variance_m2_s2 = squared(config.attitude.free_velocity_sigma_m_s);
  if (out.velocity_valid) {
    out.v_base_m_s = {wheels.last().vx_m_s, wheels.last().vy_m_s, 0.0};
    out.velocity_variance_m2_s2 = squared(config.attitude.wheel_sigma_m_s) +
                                  squared(config.attitude.wheel_sigma_share) * out.v_base_m_s.squaredNorm();
  }
  out.standing_still = out.velocity_valid && standstill.standing() && !height.ground_moves();
}

bool PriorEstimator::State::disturbed_for(double seconds) const {
  const DisturbanceJudge& judge = height.disturbance();
  return judge.unfelt() && seconds_between(judge.gated_since_ns(), imu_gate.stamp_ns()) > seconds;
}

BarometerFault PriorEstimator::State::robot_fault() const {
  const BarometerFault seen = altimeter.robot_fault();
  if (seen != BarometerFault::kOk && seen != BarometerFault::kSpiking) return seen;
  return disturbed_for(kWrongS) || height.pressure_faulty() ? BarometerFault::kWrong : seen;
}

void PriorEstimator::State::watch_barometers() {
  const auto take = [](BarometerFault& known, BarometerFault now, std::uint64_t& count) {
    if (now != known && now != BarometerFault::kOk && known == BarometerFault::kOk) ++count;
    known = now;
  };
  take(barometers.robot, robot_fault(), counters.robot_faults);
  for (std::size_t station = 0; station < barometers.base.size(); ++station) {
    take(barometers.base[station], altimeter.base_fault(station), counters.base_faults);
    barometers.base_heard[station] =
        barometers.base_heard[station] || barometers.base[station] != BarometerFault::kOff;
  }
  barometers.base_active = static_cast<std::uint8_t>(altimeter.base_active());
  barometers.base_usable = static_cast<std::uint8_t>(altimeter.base_usable_count());
  barometers.base_undecided = altimeter.base_undecided();
}

PriorEstimator::PriorEstimator(const PriorConfig& config) : state_(std::make_unique<State>(config)) {}
PriorEstimator::~PriorEstimator() = default;
PriorEstimator::PriorEstimator(PriorEstimator&&) noexcept = default;
PriorEstimator& PriorEstimator::operator=(PriorEstimator&&) noexcept = default;

const PriorCounters& PriorEstimator::counters() const { return state_->counters; }
const BarometerHealth& PriorEstimator::barometers() const { return state_->barometers; }

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
      s.move(gyro, force, dt_s, gap);
      if (s.height.ground_moves() && !moved_before) ++s.counters.moving_ground;
      s.use_device_attitude(sample, gyro, dt_s);
    } else {
      s.align(gyro, force, gap ? 0.0 : dt_s);
    }
  }
  s.gyro_before = gyro;
  s.altimeter.set_time(sample.stamp_ns);
  s.watch_barometers();
  s.fill(sample, out);
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
  if (!s.attitude.started() || !s.height.started()) return;
  const double lever_m = s.above_base(s.config.p_base_port - s.p_base_imu);
  const PressureUse use = s.height.update_pressure(reading, lever_m, s.imu_gate.stamp_ns());
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

void PriorEstimator::add_wheel(const WheelSample& sample) {
  State& s = *state_;
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
  s.new_wheels = true;
  s.standstill.add_wheel(std::hypot(sample.vx_m_s, sample.vy_m_s), sample.wz_rad_s);
}

}  // namespace isobar

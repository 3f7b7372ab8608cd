// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/input_check.hpp"

#include "core/contradictions/barometer_swap.hpp"
#include "core/contradictions/clock_verdicts.hpp"
#include "core/contradictions/gravity_check.hpp"
#include "core/contradictions/motion_comparison.hpp"
#include "core/contradictions/scan_motion.hpp"
#include "core/contradictions/turn_verdicts.hpp"
#include "core/contradictions/way_verdicts.hpp"

namespace isobar {

struct InputCheck::State {
  explicit State(const InputCheckConfig& config)
      : lidar_rpy_deg(config.lidar.rpy_deg),
        R_base_imu(rotation_from_rpy_deg(config.imu.rpy_deg)),
        gravity(config.imu.rpy_deg),
        scan_motion(config.lidar.T_base_sensor()) {}

  StreamTimes& times_of(CheckedSensor sensor) { return times[static_cast<std::size_t>(sensor)]; }

  [[nodiscard]] TurnComparisons compare() const {
    return {.gyro_by_scans = compare_turns(gyro, scans),
            .gyro_by_wheels = compare_turns(gyro, wheels),
            .wheels_by_scans = compare_turns(wheels, scans)};
  }

  Eigen::Vector3d lidar_rpy_deg;
  Eigen::Matrix3d R_base_imu;
  GravityCheck gravity;
  ScanMotion scan_motion;
  MotionSeries gyro;  // its way: changes of speed by the accelerometer
  MotionSeries wheels;
  MotionSeries scans;
  PressureSeconds robot_air;
  PressureSeconds base_air;
  AllStreamTimes times;
};

InputCheck::InputCheck(const InputCheckConfig& config) : state_(std::make_unique<State>(config)) {}
InputCheck::~InputCheck() = default;

void InputCheck::add_imu(const ImuSample& sample) {
  State& s = *state_;
  s.times_of(CheckedSensor::kImu).add(sample.stamp_ns);
  s.gravity.add(sample);
  const Eigen::Vector3d force = s.R_base_imu * sample.accel_m_s2;
  s.gyro.add_rate(sample.stamp_ns, {(s.R_base_imu * sample.gyro_rad_s).z(), force.x(), force.y()});
}

void InputCheck::add_wheel(const WheelSample& sample) {
  state_->times_of(CheckedSensor::kWheels).add(sample.stamp_ns);
  state_->wheels.add_rate(sample.stamp_ns, {sample.wz_rad_s, sample.vx_m_s, sample.vy_m_s});
}

void InputCheck::add_pressure(const PressureSample& sample) {
  state_->times_of(CheckedSensor::kBarometer).add(sample.stamp_ns);
  state_->robot_air.add(sample);
}

void InputCheck::add_base_pressure(const PressureSample& sample) {
  state_->times_of(CheckedSensor::kBaseBarometer).add(sample.stamp_ns);
  if (sample.station == 0) state_->base_air.add(sample);
}

void InputCheck::add_scan(const Scan& scan) {
  State& s = *state_;
  s.times_of(CheckedSensor::kLidar).add(scan.end_stamp_ns);
  const auto step = s.scan_motion.add(scan);
  if (step && step->turn_known) s.scans.add_step(step->from_ns, step->to_ns, step->step, step->way_known);
}

Findings InputCheck::find() const {
  const State& s = *state_;
  Findings findings;
  const TurnComparisons turns = s.compare();
  auto mount = s.gravity.mount();
  const bool points_down = mount && s.gravity.points_down();
  // The gyro turns as the others do: its axes are right, and with them the mount.
  if (points_down && (verdict_on(turns.gyro_by_scans) == TurnVerdict::kAgree ||
                      verdict_on(turns.gyro_by_wheels) == TurnVerdict::kAgree)) {
    mount->kind = Contradiction::kAccelNegated;
  }
  if (mount) findings.add(*mount);
  if (const auto unit = s.gravity.unit()) findings.add(*unit);
  add_turn_findings(turns, points_down, findings);
  WayWitnesses witnesses;
  witnesses.wheels_turn_reversed = findings.find(Contradiction::kWheelTurnReversed) != nullptr;
  if (!mount) witnesses.acceleration = compare_accelerations(s.gyro, s.wheels);
  add_way_findings(compare_ways(s.wheels, s.scans), witnesses, s.lidar_rpy_deg, findings);
  if (const auto swapped = find_swapped_barometers(s.robot_air, s.base_air)) findings.add(*swapped);
  return findings;
}

void InputCheck::add_clocks(Findings& findings) const {
  const State& s = *state_;
  add_clock_findings({.gyro = s.gyro, .wheels = s.wheels, .scans = s.scans}, s.times, findings);
}

void InputCheck::add_overlaps(Findings& findings) const { add_missing_overlaps(state_->times, findings); }

bool InputCheck::full() const { return state_->gyro.full() || state_->scans.full(); }

bool InputCheck::turns_known() const {
  const TurnComparisons turns = state_->compare();
  return verdict_on(turns.gyro_by_scans) != TurnVerdict::kUnclear ||
         verdict_on(turns.gyro_by_wheels) != TurnVerdict::kUnclear ||
         verdict_on(turns.wheels_by_scans) != TurnVerdict::kUnclear;
}

const StreamTimes& InputCheck::times(CheckedSensor sensor) const { return state_->times_of(sensor); }

}  // namespace isobar

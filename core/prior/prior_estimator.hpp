// SPDX-License-Identifier: BSD-3-Clause
// The prior stage: pose, twist and height from IMU, wheels and barometers, before the scan is used.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/altitude/barometer_monitor.hpp"
#include "core/altitude/height_datum.hpp"
#include "core/estimates.hpp"
#include "core/prior/prior_config.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Counts of accepted and refused samples. A refused sample changes nothing else.
struct PriorCounters {
  std::uint64_t imu_accepted = 0;
  /// Alignments refused because the specific force is not gravity: in g instead of m/s^2, or a broken sensor.
  std::uint64_t imu_wrong_gravity = 0;
  std::uint64_t imu_bad_value = 0;  ///< not finite, or beyond the sensor's range
  std::uint64_t imu_bad_time = 0;   ///< not newer than the sample before, or an unconfirmed jump
  std::uint64_t imu_gaps = 0;       ///< steps of time longer than PriorLimits::imu_gap_s
  std::uint64_t imu_restarts = 0;   ///< confirmed jumps of the IMU's clock
  std::uint64_t pressure_accepted = 0;
  std::uint64_t pressure_outside_calibration = 0;  ///< used, with the correction at the range's edge
  std::uint64_t pressure_without_temperature = 0;  ///< compensated with the last known temperature
  std::uint64_t pressure_bad_value = 0;            ///< not finite, implausible, or a spike
  std::uint64_t pressure_bad_time = 0;
  std::uint64_t pressure_repeated = 0;  ///< the same value again: polled faster than it converts
  std::uint64_t pressure_gated = 0;     ///< not used: outside of the gate (doors)
  std::uint64_t pressure_steps = 0;     ///< steps of the height or of the pressure, used after a long gating
  std::uint64_t base_accepted = 0;
  std::uint64_t base_outside_calibration = 0;
  std::uint64_t base_without_temperature = 0;
  std::uint64_t base_bad_value = 0;
  std::uint64_t base_bad_time = 0;
  std::uint64_t base_repeated = 0;
  std::uint64_t base_stale = 0;          ///< too old on arrival, by the robot's clock
  std::uint64_t base_lost = 0;           ///< events: the last base station was lost
  std::uint64_t base_switched = 0;       ///< events: one base station took over from another
  std::uint64_t robot_faults = 0;        ///< events: the robot's barometer became faulty
  std::uint64_t base_faults = 0;         ///< events: a base station became faulty
  std::uint64_t thermometer_faults = 0;  ///< events: the thermometer of a barometer was left out
  std::uint64_t wheel_accepted = 0;
  std::uint64_t wheel_bad_value = 0;
  std::uint64_t wheel_bad_time = 0;
  std::uint64_t wheel_bad_variance =
      0;  ///< accepted with the configured noise: what their sender states is none
  std::uint64_t wheel_turn_slips = 0;  ///< seconds in which wheels and gyro turned differently, see SlipWatch
  std::uint64_t wheel_speed_slips = 0;  ///< seconds in which the wheels' speed did not fit the acceleration
  std::uint64_t moving_ground = 0;      ///< events: start of a moving ground (elevator rides)
};

/// Health of the barometers.
struct BarometerHealth {
  BarometerFault robot = BarometerFault::kOff;
  std::array<BarometerFault, 2> base{BarometerFault::kOff, BarometerFault::kOff};
  std::uint8_t base_active = 0;             ///< index of the base station in use, or of the last one in use
  std::uint8_t base_usable = 0;             ///< number of usable base stations
  std::array<bool, 2> base_heard{};         ///< at least one sample has arrived
  std::array<bool, 3> thermometer_wrong{};  ///< left out; of the robot, of each base station
  bool base_undecided = false;              ///< two stations disagree and neither is known to be wrong
  double height_bias_m = 0.0;               ///< estimated offset of the barometric height from the height
  double height_bias_sd_m = 0.0;            ///< of the offset's part that is still estimated
};

/// Takes samples in order of arrival and returns one Prior per accepted IMU sample, or per advance(); how it works is drawn in
/// prior_state.hpp. No clock, no allocation after construction, deterministic: the same samples in the same
/// order give the same bits. Not thread-safe.
///
/// Prior.v_base_m_s is the wheels' (vx, vy, 0): the derivative of T_odom_base, not of height_m (an elevator
/// moves the height alone). Before attitude_valid, roll and pitch of T_odom_base are zero.
class PriorEstimator {
 public:
  explicit PriorEstimator(const PriorConfig& config);
  ~PriorEstimator();
  PriorEstimator(PriorEstimator&&) noexcept;
  PriorEstimator& operator=(PriorEstimator&&) noexcept;

  /// Changes the limits, the standstill detection and the dead reckoning; the estimate goes on. Allocates
  /// nothing.
  void configure(const PriorConfig& config);
  /// Continues the height of an earlier run, before the first sample. With the base station of that run the
  /// pressure tells the height; without it, the robot stands at the height where it was.
  void resume(const HeightDatum& datum);
  /// The height datum at the time of the last IMU sample, for the next run.
  [[nodiscard]] HeightDatum height_datum() const;

  /// True, and `out` filled, if the sample was accepted.
  bool add_imu(const ImuSample& sample, Prior& out);
  /// Without an IMU (PriorConfig::has_imu): the prior at `stamp_ns` on the robot clock, from wheels and barometers;
  /// PriorPace says when. True, and `out` filled, if the stamp is newer than the last one.
  ///
  /// attitude_valid is false. While the wheels are valid, T_odom_base is their way on a plane; else it stands.
  /// height_m is that of the air alone.
  bool advance(std::int64_t stamp_ns, Prior& out);
  /// Raw samples: PriorConfig's calibrations are applied here and nowhere else.
  void add_pressure(const PressureSample& measured);
  void add_base_pressure(const PressureSample& measured);
  void add_wheel(const WheelSample& measured);

  [[nodiscard]] const PriorCounters& counters() const;
  /// At the time of the last IMU sample.
  [[nodiscard]] const BarometerHealth& barometers() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace isobar

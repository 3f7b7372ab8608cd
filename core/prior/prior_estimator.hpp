// SPDX-License-Identifier: BSD-3-Clause
// The prior stage: what inertial sensors, wheels and barometers say about the pose before the scan is looked
// at.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/altitude/barometer_monitor.hpp"
#include "core/estimates.hpp"
#include "core/prior/prior_config.hpp"
#include "core/samples.hpp"

namespace isobar {

/// What became of the samples. Refused samples change nothing else.
struct PriorCounters {
  std::uint64_t imu_accepted = 0;
  /// Starts refused because the specific force is not gravity's: in g instead of m/s^2, or a broken sensor.
  std::uint64_t imu_wrong_gravity = 0;
  std::uint64_t imu_bad_value = 0;  ///< not finite, or beyond the sensor's range
  std::uint64_t imu_bad_time = 0;   ///< not newer than the one before, or a jump not yet confirmed
  std::uint64_t imu_gaps = 0;       ///< steps of time longer than PriorLimits::imu_gap_s
  std::uint64_t imu_restarts = 0;   ///< clock jumps that were confirmed
  std::uint64_t pressure_accepted = 0;
  std::uint64_t pressure_outside_calibration = 0;  ///< used with the correction of the range's nearest place
  std::uint64_t pressure_without_temperature = 0;  ///< compensated with the last temperature that was known
  std::uint64_t pressure_bad_value = 0;            ///< not finite, implausible, or a spike
  std::uint64_t pressure_bad_time = 0;
  std::uint64_t pressure_repeated = 0;  ///< polled faster than the sensor converts: the same value again
  std::uint64_t pressure_gated = 0;     ///< further from the prediction than the gate: a door
  std::uint64_t pressure_steps = 0;     ///< gated for so long that they were believed
  std::uint64_t base_accepted = 0;
  std::uint64_t base_outside_calibration = 0;
  std::uint64_t base_without_temperature = 0;
  std::uint64_t base_bad_value = 0;
  std::uint64_t base_bad_time = 0;
  std::uint64_t base_repeated = 0;
  std::uint64_t base_stale = 0;     ///< too old for the robot's clock when they arrived
  std::uint64_t base_lost = 0;      ///< times that no base station was left
  std::uint64_t base_switched = 0;  ///< times that one base station took over from another
  std::uint64_t robot_faults = 0;   ///< times that the robot's barometer became faulty
  std::uint64_t base_faults = 0;    ///< the same for base stations
  std::uint64_t wheel_accepted = 0;
  std::uint64_t wheel_bad_value = 0;
  std::uint64_t wheel_bad_time = 0;
  std::uint64_t moving_ground = 0;  ///< times the ground was seen to move (elevator rides)
};

/// How the barometers are.
struct BarometerHealth {
  BarometerFault robot = BarometerFault::kOff;
  std::array<BarometerFault, 2> base{BarometerFault::kOff, BarometerFault::kOff};
  std::uint8_t base_active = 0;      ///< the base station that heights are measured against, or were last
  std::uint8_t base_usable = 0;      ///< base stations that could be measured against
  std::array<bool, 2> base_heard{};  ///< ever
  bool base_undecided = false;       ///< both are there, disagree, and nobody can tell which is wrong
};

/// Takes samples in order of arrival, gives one Prior an accepted IMU sample. No clock, no allocation after
/// construction, deterministic: the same samples in the same order give the same bits. One thread.
///
/// Prior.v_base_m_s is the wheels' (vx, vy, 0): it is the derivative of T_odom_base, not of height_m (an
/// elevator moves the height alone). Before attitude_valid, T_odom_base is the identity.
class PriorEstimator {
 public:
  explicit PriorEstimator(const PriorConfig& config);
  ~PriorEstimator();
  PriorEstimator(PriorEstimator&&) noexcept;
  PriorEstimator& operator=(PriorEstimator&&) noexcept;

  /// True, and `out` filled, if the sample was accepted.
  bool add_imu(const ImuSample& sample, Prior& out);
  /// Samples as the sensors gave them: PriorConfig's calibrations are applied here, and nowhere else.
  void add_pressure(const PressureSample& measured);
  void add_base_pressure(const PressureSample& measured);
  void add_wheel(const WheelSample& sample);

  [[nodiscard]] const PriorCounters& counters() const;
  /// At the time of the last IMU sample.
  [[nodiscard]] const BarometerHealth& barometers() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// A scenario: world, motion, air and sensor mounts. The sensors are simulated from this alone.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.hpp"
#include "simulation/route.hpp"
#include "simulation/time_course.hpp"
#include "simulation/trajectory.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Sensor mounts; the defaults are those of the tracked robot. base_link is on the ground below the robot's
/// centre.
struct SensorMounts {
  Mount lidar{{0.10, 0.0, 0.55}, {0.0, 0.0, 0.0}};
  Mount imu{{0.0, 0.0, 0.20}, {0.0, 0.0, 0.0}};
  Eigen::Vector3d pressure_port_m{-0.15, 0.05, 0.35};
};

/// Sources of local pressure disturbances.
struct AirZones {
  std::vector<int> zone;                ///< ventilated zone that the robot is in, per raw sample
  double door_pulses_1_s = 0.0;         ///< mean rate of door movements nearby
  std::optional<PressureRange> pulses;  ///< peaks of door pulses; none: drawn by AirErrors
  std::optional<PressureRange> zones;   ///< offsets of zones, of either sign; none: drawn by AirErrors
  double piston_pa_s_m = 0.0;     ///< piston effect of an elevator: pressure in the cabin per m/s of climb
  double port_coefficient = 0.0;  ///< share of the dynamic pressure of driving that acts on the port
  double wind_m_s = 0.0;          ///< mean wind outdoors, whose gusts act on both ports; 0: indoors
  double port_wind_share = 0.0;   ///< share of the wind's dynamic pressure at the robot's port, signed
  double base_wind_share = 0.0;   ///< the same at the base station's port
  Ramp common_ramp;               ///< of the pressure at height 0, besides the weather
  Oscillation common_gust;        ///< the same
};

/// Input of the sensor models.
struct Scenario {
  std::string description;
  World world;
  Trajectory trajectory;
  std::vector<LabelledSpan> labels;
  std::vector<RawPose> raw;
  AirZones air;
  SensorMounts mounts;
  bool has_wheels = true;
  bool tracked = true;                   ///< the wheels are tracks, which slip
  double air_temperature_c = 20.0;       ///< mean over the column of air between base station and robot
  double base_height_m = 1.0;            ///< height of the base station's port in the world frame
  double start_pressure_pa = 101'325.0;  ///< at height 0 and time 0
  std::vector<TimeSpan> base_silent;     ///< the base station is out of reach
};

[[nodiscard]] Scenario make_three_floors(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_elevator(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_round_trip(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_four_floors(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_moulin(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_stairs_demo(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_hill(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_parking(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_stairs(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_corridor(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_city(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_city_10km(std::uint64_t seed, bool short_form);
[[nodiscard]] Scenario make_city_hour(std::uint64_t seed, bool short_form);

}  // namespace isobar::simulation

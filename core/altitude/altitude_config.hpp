// SPDX-License-Identifier: BSD-3-Clause
// Settings of the altimeter. Every field states its unit and why it has its default; the ranges stand in the
// settings table (config/).
#pragma once

#include <cstdint>

#include "core/plausibility.hpp"

namespace isobar {

/// Which air temperature the hypsometric factor uses.
enum class AirTemperatureMode : std::uint8_t {
  kAuto,   ///< from the barometers' own thermometers, see AirTemperatureTracker
  kFixed,  ///< AirTemperatureConfig::fixed_c
};

/// Air temperature between base station and robot. 10 K wrong is 3.4 % of every height.
struct AirTemperatureConfig {
  AirTemperatureMode mode = AirTemperatureMode::kAuto;

  /// Air temperature [degC]. Used where mode is kFixed, and by kAuto until a thermometer has spoken
  /// (or if none ever does). 20 is what buildings are heated to; outdoors, say what it is.
  double fixed_c = 20.0;

  /// What the coldest barometer is expected to read above the air [K]; taken off. Even a ventilated
  /// base station's chip warms itself by 0.3 to 1.2 K and the thermometers are good to 0.5 K: half a kelvin
  /// (2 cm at 12 m) is the middle between that and a thermometer in the air itself.
  double expected_self_heating_k = 0.5;

  /// Most that a barometer warms itself above the air [K]. The estimate never falls further than
  /// this below the coldest sensor of the moment: what it remembers of a colder place or hour must not stay.
  /// Chips near a processor read 2 to 8 K too warm.
  double max_self_heating_k = 8.0;

  /// Time constants with which the estimate goes down and up [s]. Down: a sensor colder than the
  /// estimate proves colder air; the minute keeps the height from jumping (5 K at 12 m are 20 cm). Up: a
  /// rising reading is self-heating rather than weather, so it is believed only over an hour.
  double fall_time_s = 60.0;
  double rise_time_s = 3600.0;

  /// Low-pass of each thermometer [s]: takes out its noise before the lowest is taken.
  double smoothing_time_s = 5.0;

  /// Uncertainty of the mean air temperature of the column [K]; goes into the height's variance.
  double sigma_k = 2.0;
};

/// How barometers are checked and turned into height differences.
struct AltimeterConfig {
  AirTemperatureConfig air;

  /// Air pressures at the site [Pa]. 30 kPa is 9 km up, 115 kPa a mine 1.1 km down.
  double min_pressure_pa = kGroundPressurePa.lowest;
  double max_pressure_pa = kGroundPressurePa.highest;

  /// Bounds of the white noise of one sample, estimated online [Pa]. Below the floor no chip
  /// goes (DPS310 at its best 0.2 Pa); `initial` holds until enough samples have come (DPS310, 32 Hz: 0.35
  /// Pa).
  double noise_floor_pa = 0.1;
  double noise_ceiling_pa = 20.0;
  double initial_noise_pa = 0.5;

  /// How fast the pressure at the base may wander between two samples, as a random walk [Pa/sqrt(s)]. 0.06
  /// smooths a 32 Hz DPS310 over about 1 s: its noise shrinks eight times, and the lag behind
  /// a storm of 100 Pa an hour is 0.03 Pa.
  double base_walk_pa_sqrt_s = 0.06;

  /// A base station silent for longer is lost [s]: its last pressure is held, the height
  /// becomes a single barometer's. Weather moves 0.1 to 0.3 Pa meanwhile. Samples that are older than this
  /// when they arrive are refused.
  double base_timeout_s = 10.0;

  /// Difference between successive samples of one sensor that no motion explains [Pa]: a spike.
  /// 200 Pa is 17 m in one sample. A new level is believed once `spike_confirmations` samples agree on it.
  double spike_pa = 200.0;
  std::uint32_t spike_confirmations = 5;

  /// A sensor whose value has not changed by one bit for longer (or for six of its own intervals) is stuck,
  /// and counts as silent [s]. Noise alone changes a working sensor's last digit at every
  /// conversion.
  double stuck_timeout_s = 1.5;

  /// A sensor that has sent nothing for longer (or for three of its own intervals) is off [s].
  double silent_timeout_s = 0.4;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// True air pressure at the ports of the robot and of the base station.
#pragma once

#include "simulation/random.hpp"
#include "simulation/scenario.hpp"
#include "simulation/spline.hpp"

namespace isobar::simulation {

/// Pressure disturbances besides height. The defaults are zero, for tests.
struct AirErrors {
  double ramp_pa_s = 0.0;            ///< weather: drift while a front passes
  double walk_pa_sqrt_s = 0.0;       ///< weather: random walk
  double turbulence_pa = 0.0;        ///< rms, common to robot and base (wind on the building), tau 60 s
  double local_turbulence_pa = 0.0;  ///< rms, independent at robot and base, tau 4 s
  double zone_sigma_pa = 0.0;        ///< standard deviation of the offset of a ventilated zone
  double pulse_pa = 0.0;             ///< typical peak of a door pulse

  /// Random disturbances of realistic size; sources in atmosphere.cpp.
  [[nodiscard]] static AirErrors draw(Random random);
};

/// Pressure as a smooth function of time and height, without sensor errors.
class Atmosphere {
 public:
  Atmosphere(const Scenario& scenario, const AirErrors& errors, Random random);

  /// Pressure at the robot's port [Pa]; `height_m`: of the port in the world frame.
  [[nodiscard]] double robot_pa(double time_s, double height_m) const;
  /// Pressure at the base station's port [Pa].
  [[nodiscard]] double base_pa(double time_s) const;

 private:
  [[nodiscard]] double column(double pressure_pa, double height_m) const;

  double air_temperature_k_;
  double base_height_m_;
  Channel common_pa_;  ///< at height 0, common to both
  Channel robot_pa_;   ///< local disturbance at the robot
  Channel base_pa_;    ///< local disturbance at the base station
};

}  // namespace isobar::simulation

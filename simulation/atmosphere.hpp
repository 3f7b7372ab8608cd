// SPDX-License-Identifier: BSD-3-Clause
// The true air pressure at the robot's and at the base station's port.
#pragma once

#include "simulation/random.hpp"
#include "simulation/scenario.hpp"
#include "simulation/spline.hpp"

namespace isobar::simulation {

/// What disturbs the air besides height. Defaults are none, for tests.
struct AirErrors {
  double ramp_pa_s = 0.0;            ///< weather: a front goes by
  double walk_pa_rts = 0.0;          ///< weather: random walk
  double turbulence_pa = 0.0;        ///< common, wind on the building; time constant about a minute
  double local_turbulence_pa = 0.0;  ///< robot and base apart, time constant some seconds
  double zone_sigma_pa = 0.0;        ///< step between ventilated zones
  double pulse_pa = 0.0;             ///< typical door pulse

  [[nodiscard]] static AirErrors draw(Random random);
};

/// Pressure as a function of time and height; smooth, exact, made before the sensors sample it.
class Atmosphere {
 public:
  Atmosphere(const Scenario& scenario, const AirErrors& errors, Random random);

  /// At the robot's port, height_m in the world frame.
  [[nodiscard]] double robot_pa(double time_s, double height_m) const;
  [[nodiscard]] double base_pa(double time_s) const;

 private:
  [[nodiscard]] double column(double pressure_pa, double height_m) const;

  double air_temperature_k_;
  double base_height_m_;
  Channel common_pa_;  ///< at height 0
  Channel robot_pa_;   ///< added at the robot
  Channel base_pa_;    ///< added at the base station
};

}  // namespace isobar::simulation

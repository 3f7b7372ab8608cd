// SPDX-License-Identifier: BSD-3-Clause
// The paper's sensitivity experiment: a rig with two barometers is lifted in small known steps next to a
// second rig that does not move.
#pragma once

#include <cstdint>
#include <vector>

#include "core/samples.hpp"

namespace isobar::simulation {

struct RigRequest {
  std::uint64_t seed = 1;   ///< random seed of the air and of every sensor's errors
  double step_m = 0.03;     ///< height of a step
  int steps = 10;           ///< number of steps, >= 1
  double dwell_s = 20.0;    ///< mean time between steps; each varies by +-20 %, as it is lifted by hand
  double distance_m = 1.0;  ///< between the two rigs
  double dps310_noise_pa =
      0.35;  ///< white noise of a DPS310, standard deviation of a sample: data sheet, 32 Hz
};

/// Samples of both barometers of one kind, on a common clock.
struct RigPair {
  std::vector<PressureSample> moved;
  std::vector<PressureSample> standing;
};

struct RigRun {
  RigPair dps310;
  RigPair ceramic;
  std::vector<std::int64_t> moves_ns;  ///< stamp of the middle of each lift
  double lift_s = 0.0;                 ///< duration of a lift
  double air_temperature_c = 0.0;
};

/// Simulates the experiment. The same request gives the same samples.
///
/// Errors: weather, common turbulence, turbulence between the rigs, and offset, scale, flicker, warm-up and
/// temperature of each sensor. No door pulses and no zones, since the paper's room was quiet.
/// Turbulence between the rigs: AirErrors::local_turbulence_pa holds for sensors a few metres apart; closer
/// rigs share the larger eddies. The structure function of the pressure is proportional to
/// r^(4/3) (Obukhov 1949, Batchelor 1951), hence its rms to r^(2/3), up to kFullTurbulenceM.
RigRun simulate_rig(const RigRequest& request);

/// Distance beyond which the turbulence at both rigs is independent.
inline constexpr double kFullTurbulenceM = 4.0;

}  // namespace isobar::simulation

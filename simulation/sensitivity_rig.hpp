// SPDX-License-Identifier: BSD-3-Clause
// The paper's sensitivity experiment: a rig of two barometers is lifted in small known steps beside another
// one that stands.
#pragma once

#include <cstdint>
#include <vector>

#include "core/samples.hpp"

namespace isobar::simulation {

struct RigRequest {
  std::uint64_t seed = 1;   ///< draws the air and every sensor's errors
  double step_m = 0.03;     ///< up each time
  int steps = 10;           ///< >= 1
  double dwell_s = 20.0;    ///< mean time on a level; lifted by hand, so each is 20 % shorter to 20 % longer
  double distance_m = 1.0;  ///< between the two rigs
  /// White noise of a DPS310's sample, each [Pa]: data sheet, 32 Hz.
  double dps310_noise_pa = 0.35;
};

/// What both barometers of one kind have measured, on one clock.
struct RigPair {
  std::vector<PressureSample> moved;
  std::vector<PressureSample> standing;
};

struct RigRun {
  RigPair dps310;
  RigPair ceramic;
  std::vector<std::int64_t> moves_ns;  ///< middle of each lift
  double lift_s = 0.0;                 ///< how long each lift takes
  double air_temperature_c = 0.0;
};

/// Simulates the run. The same request gives the same samples.
///
/// All of the simulator's air and sensor errors are on: weather, turbulence in common, doors' pulses are not
/// (the paper's room was quiet), turbulence between the rigs, offset, scale, flicker, warm-up, temperature.
/// The turbulence between robot and base station is that of sensors a few metres apart (Atmosphere); rigs
/// nearer to each other share the larger eddies: the pressure's structure function grows with r^(4/3)
/// (Obukhov 1949, Batchelor 1951), hence its rms with r^(2/3) up to kFullTurbulenceM.
RigRun simulate_rig(const RigRequest& request);

/// From this distance on the turbulence at both rigs is independent [m].
inline constexpr double kFullTurbulenceM = 4.0;

}  // namespace isobar::simulation

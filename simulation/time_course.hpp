// SPDX-License-Identifier: BSD-3-Clause
// Simple functions of the time of a run: spans, ramps, oscillations.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isobar::simulation {

/// Span of the run, [start_s, end_s).
struct TimeSpan {
  double start_s = 0.0;
  double end_s = 0.0;

  [[nodiscard]] bool contains(double time_s) const { return time_s >= start_s && time_s < end_s; }
};

/// Magnitudes of random pressures, low_pa … high_pa.
struct PressureRange {
  double low_pa = 0.0;
  double high_pa = 0.0;  ///< > 0
};

/// Pressure that changes at a constant rate for a while and keeps its value afterwards.
struct Ramp {
  double rate_pa_s = 0.0;
  double start_s = 0.0;
  double duration_s = std::numeric_limits<double>::infinity();  ///< > 0

  /// Change since the start [Pa].
  [[nodiscard]] double at(double time_s) const {
    return rate_pa_s == 0.0 ? 0.0 : rate_pa_s * std::clamp(time_s - start_s, 0.0, duration_s);
  }
};

/// Sinusoidal pressure.
struct Oscillation {
  double amplitude_pa = 0.0;
  double frequency_hz = 0.0;  ///< at most 2 Hz: the air's time grid has a step of 0.05 s

  [[nodiscard]] double at(double time_s) const {
    return amplitude_pa * std::sin(2.0 * std::numbers::pi * frequency_hz * time_s);
  }
};

}  // namespace isobar::simulation

// SPDX-License-Identifier: BSD-3-Clause
// Step of the pressure without motion: another ventilation zone, a hatch, a fault of a sensor.
#pragma once

#include "core/altitude/differential_altimeter.hpp"

namespace isobar {

/// The known part of an open step. A step is an additive error of the pressure, so it is subtracted from the ratio of
/// pressures: subtracted as a height, a large step would falsify the scale of later climbs.
class PressureStep {
 public:
  /// Takes the difference between a reading and the height expected instead of it as the step.
  void open(const AltimeterReading& reading, double expected_m);
  void close() { share_ = 0.0; }
  /// Height of a reading without the step [m].
  [[nodiscard]] double height_without_m(const AltimeterReading& reading) const;

 private:
  double share_ = 0.0;  // step of the pressure / reference pressure
};

}  // namespace isobar

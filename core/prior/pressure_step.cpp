// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/pressure_step.hpp"

#include <algorithm>
#include <cmath>

namespace isobar {
namespace {

// Lower bound of the pressure ratio after subtracting a fault: it stays positive.
constexpr double kLeastRatio = 0.05;

}  // namespace

void PressureStep::open(const AltimeterReading& reading, double expected_m) {
  share_ = std::exp(-reading.height_m / reading.scale_m) - std::exp(-expected_m / reading.scale_m);
}

double PressureStep::height_without_m(const AltimeterReading& reading) const {
  if (share_ == 0.0) return reading.height_m;
  const double ratio = std::exp(-reading.height_m / reading.scale_m) - share_;
  return -reading.scale_m * std::log(std::max(ratio, kLeastRatio));
}

}  // namespace isobar

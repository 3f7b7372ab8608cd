// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "core/calibration/height_difference.hpp"
#include "run/evaluation/trajectory.hpp"

namespace isobar::tools {

/// Errors of heights against a reference after subtraction of their mean, because a barometer's zero is
/// arbitrary. Nothing else is fitted.
struct HeightErrors {
  std::size_t count = 0;  ///< number of heights compared; if 0, all other members are 0
  double offset_m = 0.0;  ///< mean of height minus reference, which was subtracted
  double rms_m = 0.0;
  double largest_m = 0.0;  ///< magnitude
  double range_m = 0.0;    ///< highest minus lowest reference height at the heights compared
};

/// Compares each height with the reference interpolated between two poses at most half a second apart;
/// heights without such poses are left out.
HeightErrors height_errors(const HeightSeries& series, const evaluation::Trajectory& reference);

}  // namespace isobar::tools

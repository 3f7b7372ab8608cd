// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "core/calibration/calibration.hpp"
#include "tools/report/box_chart.hpp"
#include "tools/report/curve_chart.hpp"

namespace isobar::report {

/// A model's name in tables and charts: the paper's, or "A'_m, as it is" and "A'_m + offset" for kNone and
/// kOffset, which the paper does not name.
std::string calibration_row_name(CompensationModel model);

/// The paper's box plot: |residual| by model.
BoxChart residual_boxes(const Calibration& calibration);

/// Residuals against the sensor's temperature, with an offset alone and with the model `chosen`.
CurveChart residual_against_temperature(const Calibration& calibration, CompensationModel chosen,
                                        std::span<const CalibrationRecording> recordings);

}  // namespace isobar::report

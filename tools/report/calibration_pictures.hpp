// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "core/calibration/calibration.hpp"
#include "tools/report/svg.hpp"

namespace isobar::report {

/// How a model is called beside the paper's: "A'_m, as it is" and "offset alone" for what is no model of it.
std::string calibration_row_name(CompensationModel model);

/// The paper's box plot: |residual| by model.
Picture residual_boxes(const Calibration& calibration);

/// Residuals over the sensor's temperature after an offset alone and after `chosen`.
Picture residual_against_temperature(const Calibration& calibration, CompensationModel chosen,
                                     std::span<const CalibrationRecording> recordings);

}  // namespace isobar::report

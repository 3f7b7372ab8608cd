// SPDX-License-Identifier: BSD-3-Clause
// The charts of an evaluated run that are not along the way: see report_data.hpp for those.
#pragma once

#include <optional>

#include "run/evaluation/evaluated_run.hpp"
#include "tools/report/box_chart.hpp"
#include "tools/report/curve_chart.hpp"

namespace isobar::report {

/// The method that the report is about: "adaptive" if present, else "3dof", else the first.
const evaluation::EvaluatedMethod& main_method(const evaluation::EvaluatedRun& run);

/// The paper's box plot of the relative error on z, one method per row.
BoxChart z_rpe_chart(const evaluation::EvaluatedRun& run);

/// The altimeter's heights in the reference's frame over the distance travelled by the reference: of the main method,
/// else of the first that has an altimeter; empty without one.
Curve altimeter_curve(const evaluation::EvaluatedRun& run);

/// Histograms of the time per scan of each method; nullopt if no status file has times. Times beyond the axis are counted
/// in the last bin.
std::optional<CurveChart> scan_time_chart(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report

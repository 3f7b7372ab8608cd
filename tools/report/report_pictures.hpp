// SPDX-License-Identifier: BSD-3-Clause
// The report's pictures of an evaluated run. Distances are travelled by the reference.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/evaluation/evaluated_run.hpp"
#include "tools/report/svg.hpp"

namespace isobar::report {

struct PictureSize {
  double width = 1040.0;
  double height = 340.0;
};

/// The method that the report is about: "adaptive" if present, else "3dof", else the first.
const evaluation::EvaluatedMethod& main_method(const evaluation::EvaluatedRun& run);
/// The other method with the largest height error, only of those with a map if `needs_map`; null without one.
const evaluation::EvaluatedMethod* contrast_method(const evaluation::EvaluatedRun& run, bool needs_map);

/// The paper's box plot of the relative error on z, one method per row.
Picture z_rpe_picture(const evaluation::EvaluatedRun& run, double width);

/// Height along the way: reference, altimeter, every method.
Picture height_picture(const evaluation::EvaluatedRun& run, const PictureSize& size, const std::string& id);

/// Height error along the way, clipped at ±limit_m if given.
Picture height_error_picture(const evaluation::EvaluatedRun& run, const PictureSize& size,
                             std::optional<double> limit_m, const std::string& id);
/// Limit of the close-up of the height error; nullopt if the full picture shows the main method well enough.
std::optional<double> close_up_limit_m(const evaluation::EvaluatedRun& run);

/// Side elevations of the maps of the main method and of contrast_method(); empty without maps.
struct SideView {
  std::string method;
  Picture picture;
  bool is_half = false;  ///< half as wide as the page
};
std::vector<SideView> side_view_pictures(const evaluation::EvaluatedRun& run);

/// Plan view of all paths over the map of the main method, if it has one.
Picture top_view_picture(const evaluation::EvaluatedRun& run);

/// Time per scan of each method; nullopt if no status file has times.
std::optional<Picture> scan_time_picture(const evaluation::EvaluatedRun& run, double width);

}  // namespace isobar::report

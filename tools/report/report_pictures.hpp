// SPDX-License-Identifier: BSD-3-Clause
// The report's pictures, made from an evaluated run. Distances are those travelled by the reference.
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

/// The method the report is about: "3dof" if it took part, else the first.
const evaluation::EvaluatedMethod& main_method(const evaluation::EvaluatedRun& run);
/// The other method with the largest height error, of those that have a map if `needs_map`; null if there is
/// none.
const evaluation::EvaluatedMethod* contrast_method(const evaluation::EvaluatedRun& run, bool needs_map);

/// The paper's box plot of the relative error on z, a method a row.
Picture z_rpe_picture(const evaluation::EvaluatedRun& run, double width);

/// Height along the way: reference, altimeter, every method.
Picture height_picture(const evaluation::EvaluatedRun& run, const PictureSize& size, const std::string& id);

/// Height error along the way; cut at +-limit_m if given.
Picture height_error_picture(const evaluation::EvaluatedRun& run, const PictureSize& size,
                             std::optional<double> limit_m, const std::string& id);
/// Where to cut the second height error picture so that the main method can be seen; nothing if the first
/// does.
std::optional<double> close_up_limit_m(const evaluation::EvaluatedRun& run);

/// Maps from the side, of the main method and of the one furthest off in height. Empty if no map was given.
struct SideView {
  std::string method;
  Picture picture;
  bool is_half = false;  ///< two of them fit beside each other
};
std::vector<SideView> side_view_pictures(const evaluation::EvaluatedRun& run);

/// Map of the main method (the reference's path alone if there is none) from above, with all paths.
Picture top_view_picture(const evaluation::EvaluatedRun& run);

/// Time per scan of each method; nothing if no status says.
std::optional<Picture> scan_time_picture(const evaluation::EvaluatedRun& run, double width);

}  // namespace isobar::report

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace isobar::report {

/// Look of a line.
struct Stroke {
  /// "#rrggbb[aa]", or a custom property of the report's style, such as "--ink", which follows light and dark.
  std::string colour = "--ink";
  double width = 1.0;  ///< [px]
  std::string dash{};  ///< lengths of dashes and gaps [px], "8 3"; empty: solid line
};

/// The lengths of `stroke.dash`.
std::vector<double> dash_lengths(const Stroke& stroke);

}  // namespace isobar::report

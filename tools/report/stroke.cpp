// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/stroke.hpp"

#include <sstream>

namespace isobar::report {

std::vector<double> dash_lengths(const Stroke& stroke) {
  std::vector<double> lengths;
  std::istringstream words(stroke.dash);
  for (double length = 0.0; words >> length;) lengths.push_back(length);
  return lengths;
}

}  // namespace isobar::report

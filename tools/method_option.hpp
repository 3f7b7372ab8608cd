// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "core/estimates.hpp"
#include "core/names.hpp"

namespace isobar::tools {

/// All methods, in the order of the paper's comparison.
inline constexpr std::array<Method, 7> kAllMethods = {
    Method::kAdaptive,     Method::k6Dof, Method::k6DofAltitude, Method::kOdometry,
    Method::k4DofAltitude, Method::k4Dof, Method::k3Dof};

/// "6dof, 6dof-altitude, …"
inline std::string method_names() {
  std::string names;
  for (const Method method : kAllMethods) {
    names += (names.empty() ? "" : ", ") + std::string(kMethodNames.name(method));
  }
  return names;
}

}  // namespace isobar::tools

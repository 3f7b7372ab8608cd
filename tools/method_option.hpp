// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/estimates.hpp"
#include "core/names.hpp"

namespace isobar::tools {

/// All methods, in the order of the paper's comparison.
inline constexpr std::array<Method, 6> kAllMethods = {Method::k6Dof,     Method::k6DofAltitude,
                                                      Method::kOdometry, Method::k4DofAltitude,
                                                      Method::k4Dof,     Method::k3Dof};

/// The method of this name; nothing for an unknown name.
inline std::optional<Method> method_of(std::string_view name) {
  for (const Method method : kAllMethods) {
    if (method_name(method) == name) return method;
  }
  return std::nullopt;
}

/// "6dof, 6dof-altitude, …"
inline std::string method_names() {
  std::string names;
  for (const Method method : kAllMethods) {
    names += (names.empty() ? "" : ", ") + std::string(method_name(method));
  }
  return names;
}

}  // namespace isobar::tools

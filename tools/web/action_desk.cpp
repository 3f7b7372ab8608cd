// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/action_desk.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry.hpp"
#include "core/squared.hpp"

namespace isobar::web {

std::optional<ipc::PoseHint> parse_hint(std::string_view body, std::string& reason) {
  // The same errors, 1 sigma, as those that `isobar initial-pose` states by default.
  constexpr double kSigmaM = 0.5;
  constexpr double kSigmaRad = 15.0 * kRadPerDeg;
  const auto json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object()) {
    reason = "the request must be a JSON object";
    return std::nullopt;
  }
  std::array<double, 3> values{};
  constexpr std::array<const char*, 3> kKeys{"x_m", "y_m", "yaw_deg"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const auto found = json.find(kKeys[i]);
    if (found == json.end() || !found->is_number()) {
      reason = std::string(kKeys[i]) + " must be a number";
      return std::nullopt;
    }
    values[i] = found->get<double>();
  }
  ipc::PoseHint hint;
  hint.x_m = values[0];
  hint.y_m = values[1];
  hint.yaw_rad = std::remainder(values[2] * kRadPerDeg, 2.0 * kPi);
  hint.covariance[0] = hint.covariance[7] = squared(kSigmaM);
  hint.covariance[35] = squared(kSigmaRad);
  if (const char* rule = ipc::implausibility(hint); rule != nullptr) {
    reason = rule;
    return std::nullopt;
  }
  return hint;
}

}  // namespace isobar::web

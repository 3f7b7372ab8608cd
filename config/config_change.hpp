// SPDX-License-Identifier: BSD-3-Clause
// What a new configuration changes in a running program.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "config/config.hpp"
#include "config/setting.hpp"

namespace isobar {

/// When a program can apply a changed setting: Setting::apply, or less.
using ApplyOf = std::function<Apply(const Setting&)>;

/// Changed keys by the time of their effect.
struct ConfigChange {
  Config running;                  ///< the running configuration with the live and stage keys of the new one
  std::vector<std::string> live;   ///< keys that take effect at once
  std::vector<std::string> stage;  ///< keys whose stage is rebuilt
  std::vector<std::string> at_start;  ///< keys that wait for the next start of the program

  /// Whether a live or stage key is `prefix` or lies below it ("registration.").
  [[nodiscard]] bool concerns(std::string_view prefix) const;
  /// Whether nothing is to be done now.
  [[nodiscard]] bool nothing_now() const { return live.empty() && stage.empty(); }
};

/// Compares the values that run with those of a new configuration.
/// @throws ConfigErrors "source: key: rule" when the running values and those that can be applied now break a
/// rule together
ConfigChange change_to(const Config& running, const Config& next, const ApplyOf& apply_of,
                       const std::string& source);

}  // namespace isobar

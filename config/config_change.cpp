// SPDX-License-Identifier: BSD-3-Clause
#include "config/config_change.hpp"

#include <algorithm>
#include <type_traits>

#include "config/problems.hpp"
#include "config/setting_rules.hpp"
#include "config/value_text.hpp"

namespace isobar {
namespace {

/// Copies the value of one setting to the same setting of another Config.
void copy_value(const Setting& from, const Setting& to) {
  std::visit([&to](auto* value) { *std::get<std::remove_const_t<decltype(value)>>(to.target) = *value; },
             from.target);
}

}  // namespace

bool ConfigChange::concerns(std::string_view prefix) const {
  const auto is_below = [prefix](const std::string& key) { return key.starts_with(prefix); };
  return std::any_of(live.begin(), live.end(), is_below) || std::any_of(stage.begin(), stage.end(), is_below);
}

ConfigChange change_to(const Config& running, const Config& next, const ApplyOf& apply_of,
                       const std::string& source) {
  ConfigChange change;
  change.running = running;
  Config wanted = next;
  const std::vector<Setting> ours = settings_of(change.running);
  const std::vector<Setting> theirs = settings_of(wanted);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (value_text(ours[i]) == value_text(theirs[i])) continue;
    const Apply apply = apply_of(ours[i]);
    if (apply == Apply::kRestart) {
      change.at_start.push_back(ours[i].key);
      continue;
    }
    (apply == Apply::kLive ? change.live : change.stage).push_back(ours[i].key);
    copy_value(theirs[i], ours[i]);
  }
  Problems problems;
  std::string words = source + ": beside the running values, which change at the next start";
  check_together(
      change.running, [&words](const std::string& /*key*/) { return words; }, problems);
  problems.throw_if_any();
  return change;
}

}  // namespace isobar

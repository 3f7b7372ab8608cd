// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "config/setting.hpp"

namespace isobar {

/// Adds the settings of one section to the table. A returned reference is valid until the next call.
class SectionBuilder {
 public:
  /// `used_by`: the roles that use the settings, until used_by() is called.
  SectionBuilder(const std::string& section, UsedBy used_by, std::vector<Setting>& settings);

  /// A number, or a list of numbers, each within lowest … highest.
  Setting& number(const char* name, Setting::Target target, const char* unit, double lowest, double highest,
                  const char* doc);

  Setting& flag(const char* name, bool& target, const char* doc);

  Setting& text(const char* name, std::string& target, TextRule rule, const char* doc);

  /// One of `choices`: a text, a whole number, or an enumerator, whose value is the index.
  Setting& choice(const char* name, Setting::Target target, const std::vector<std::string>& choices,
                  const char* doc);

  /// When a change of the settings added from here on takes effect.
  void applies(Apply apply) { apply_ = apply; }

  /// The roles that use the settings added from here on.
  void used_by(UsedBy used_by) { used_by_ = used_by; }

 private:
  Setting& add(const char* name, Setting::Target target, const char* doc);

  std::string prefix_;
  UsedBy used_by_;
  Apply apply_ = Apply::kRestart;
  std::vector<Setting>& settings_;
};

}  // namespace isobar

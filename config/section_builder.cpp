// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {

SectionBuilder::SectionBuilder(const std::string& section, UsedBy used_by, std::vector<Setting>& settings)
    : prefix_(section + "."), used_by_(used_by), settings_(settings) {}

Setting& SectionBuilder::number(const char* name, Setting::Target target, const char* unit, double lowest,
                                double highest, const char* doc) {
  Setting& setting = add(name, target, doc);
  setting.unit = unit;
  setting.lowest = lowest;
  setting.highest = highest;
  return setting;
}

Setting& SectionBuilder::flag(const char* name, bool& target, const char* doc) {
  return add(name, &target, doc);
}

Setting& SectionBuilder::text(const char* name, std::string& target, TextRule rule, const char* doc) {
  Setting& setting = add(name, &target, doc);
  setting.text_rule = rule;
  return setting;
}

Setting& SectionBuilder::choice(const char* name, Setting::Target target,
                                const std::vector<std::string>& choices, const char* doc) {
  Setting& setting = add(name, target, doc);
  setting.choices = choices;
  return setting;
}

Setting& SectionBuilder::add(const char* name, Setting::Target target, const char* doc) {
  settings_.push_back(
      {.key = prefix_ + name, .target = target, .doc = doc, .used_by = used_by_, .apply = apply_});
  return settings_.back();
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"
#include "config/setting.hpp"
#include "config/setting_rules.hpp"
#include "config/value_text.hpp"
#include "tools/manual/pages.hpp"

namespace isobar::manual {
namespace {

std::string rule_of(const Setting& setting) {
  if (!setting.choices.empty()) return "One of " + joined(setting.choices, ", ") + ". ";
  const std::string range = range_text(setting);
  return range.empty() ? "" : range.substr(std::string(" within ").size()) + ". ";
}

std::string apply_of(Apply apply) {
  switch (apply) {
    case Apply::kLive:
      return "A change takes effect at once.";
    case Apply::kStage:
      return "A change starts its stage anew.";
    case Apply::kRestart:
      return "A change takes effect at the next start.";
  }
  return "";
}

void add_settings(const std::vector<Setting>& settings, Audience audience, Page& page) {
  std::string section;
  for (const Setting& setting : settings) {
    if (setting.audience != audience) continue;
    if (setting.section() != section) {
      section = setting.section();
      page.subheading("[" + section + "]");
      page.paragraph(std::string(section_doc(section)));
    }
    page.entry(setting.key + " = " + value_text(setting),
               rule_of(setting) + setting.doc + " " + apply_of(setting.apply));
  }
}

}  // namespace

Page settings_page(const std::string& version) {
  Page page("isobar.toml", 5, version, "configuration of isobard and isobar-dds");
  page.heading("Description");
  page.paragraph(
      "Every setting may be left out; the values below are the defaults. Keys may stand in sections or be "
      "spelled with dots. `isobar config check` checks a file, `isobar config show` prints all settings.");
  page.lines("[lidar]\nport = 2368\nxyz_m = [0.1, 0.0, 0.6]");
  Config config;
  const std::vector<Setting> settings = settings_of(config);
  page.heading("Basic settings");
  page.paragraph("Those to set first on a robot or a base station.");
  add_settings(settings, Audience::kBasic, page);
  page.heading("Expert settings");
  page.paragraph("The defaults suit most robots.");
  add_settings(settings, Audience::kExpert, page);
  return page;
}

}  // namespace isobar::manual

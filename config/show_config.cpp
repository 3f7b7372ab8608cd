// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string_view>

#include "config/config_io.hpp"
#include "config/setting.hpp"
#include "config/value_text.hpp"

namespace isobar {
namespace {

constexpr std::size_t kLineWidth = 110;

/// Comment lines of at most kLineWidth bytes, broken between words.
void append_comment(std::string_view text, std::string& out) {
  while (!text.empty()) {
    std::size_t end = text.size();
    if (end > kLineWidth - 2) {
      const auto blank = text.rfind(' ', kLineWidth - 2);
      end = blank == std::string_view::npos ? kLineWidth - 2 : blank;
    }
    out += "# " + std::string(text.substr(0, end)) + "\n";
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with(' ') ? 1 : 0);
  }
}

std::string rule_of(const Setting& setting) {
  if (!setting.choices.empty()) {
    std::string text = "One of";
    for (const std::string& choice : setting.choices) {
      text += (text == "One of" ? " " : ", ") + choice;
    }
    return text + ". ";
  }
  const std::string range = range_text(setting);  // " within a … b unit"
  return range.empty() ? "" : range.substr(std::string_view(" within ").size()) + ". ";
}

void append_settings(const std::vector<Setting>& settings, std::string& out) {
  std::string section;
  for (const Setting& setting : settings) {
    if (setting.section() != section) {
      section = setting.section();
      out += "\n";
      append_comment(section_doc(section), out);
      out += "[" + section + "]\n";
    } else {
      out += "\n";
    }
    append_comment(rule_of(setting) + setting.doc, out);
    out += setting.name() + " = " + value_text(setting) + "\n";
  }
}

}  // namespace

std::string show_config(const Config& config) {
  Config copy = config;
  std::string out;
  append_comment(
      "Settings of isobard, isobar-dds and isobar. Every key may be left out: what stands here is its "
      "default or "
      "the value in use. `isobar config check FILE` checks a file; `isobar config show [FILE]` prints this "
      "one.",
      out);
  std::vector<Setting> settings = settings_of(copy);
  if (config.role == Role::kBaseStation) {
    std::erase_if(settings, [](const Setting& setting) { return is_for_robots_only(setting.key); });
  }
  append_settings(settings, out);
  return out;
}

std::string show_compensation(const CompensationConfig& compensation, const std::string& comment) {
  CompensationConfig copy = compensation;
  std::vector<Setting> settings;
  add_compensation_settings("compensation", copy, settings);
  std::string out;
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    append_comment(std::string_view(comment).substr(begin, end - begin), out);
    begin = end + 1;
  }
  append_settings(settings, out);
  return out;
}

}  // namespace isobar

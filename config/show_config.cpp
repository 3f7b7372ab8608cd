// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string_view>

#include "config/config_io.hpp"
#include "config/config_layer.hpp"
#include "config/end_mark.hpp"
#include "config/setting.hpp"
#include "config/setting_rules.hpp"
#include "config/value_text.hpp"

namespace isobar {
namespace {

constexpr std::size_t kLineBytes = 110;  // line length of the sources, too

/// Comment lines of at most kLineBytes, broken between words.
void append_comment(std::string_view text, std::string& out) {
  while (!text.empty()) {
    std::size_t end = text.size();
    if (end > kLineBytes - 2) {
      const auto blank = text.rfind(' ', kLineBytes - 2);
      end = blank == std::string_view::npos ? kLineBytes - 2 : blank;
    }
    out += "# " + std::string(text.substr(0, end)) + "\n";
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with(' ') ? 1 : 0);
  }
}

/// "0.1 … 10 m. " or "One of a, b. "; empty for a setting without such a rule.
std::string rule_sentence(const Setting& setting) {
  if (!setting.choices.empty()) {
    std::string text = "One of";
    for (const std::string& choice : setting.choices) {
      text += (text == "One of" ? " " : ", ") + choice;
    }
    return text + ". ";
  }
  const std::string range = range_text(setting);
  return range.empty() ? "" : range.substr(std::string_view(" within ").size()) + ". ";
}

/// When a changed value takes effect; empty for the next start.
std::string_view apply_sentence(Apply apply) {
  switch (apply) {
    case Apply::kLive:
      return "[live] ";
    case Apply::kStage:
      return "[stage] ";
    case Apply::kRestart:
      return "";
  }
  return "";
}

void append_setting(const Setting& setting, const std::string& spelled, const KeyOrigins& origins,
                    std::string& out) {
  append_comment(std::string(apply_sentence(setting.apply)) + rule_sentence(setting) + setting.doc, out);
  if (const auto origin = origins.find(setting.key); origin != origins.end()) {
    out += "# From " + origin->second.file + ":" + std::to_string(origin->second.line) + "\n";
  }
  out += spelled + " = " + value_text(setting) + "\n";
}

/// The settings of one audience, under a heading. Keys are dotted (section.name): a section may have settings
/// of both audiences, and TOML allows each [section] only once.
void append_audience(const std::vector<Setting>& settings, Audience audience, const char* heading,
                     const KeyOrigins& origins, std::string& out) {
  out += "\n";
  append_comment(heading, out);
  std::string section;
  for (const Setting& setting : settings) {
    if (setting.audience != audience) continue;
    if (setting.section() != section) {
      section = setting.section();
      out += "\n\n";
      append_comment("---- " + section + ": " + std::string(section_doc(section)), out);
    }
    out += "\n";
    append_setting(setting, setting.key, origins, out);
  }
}

std::string show(const Config& config, const KeyOrigins& origins, Shown shown, const std::string& source) {
  Config copy = config;
  std::vector<Setting> settings = settings_of(copy);
  if (config.role == Role::kBaseStation) {
    std::erase_if(settings, [](const Setting& setting) { return setting.used_by == UsedBy::kRobot; });
  }
  std::string out;
  append_comment(
      "Settings of isobard, isobar-dds and isobar. Every key may be left out; the values here are the "
      "defaults "
      "or those in use. A running isobard takes a changed file in: [live] marks the values that change at "
      "once, [stage] those whose stage is rebuilt while poses go on; the others take effect at the next "
      "start. `isobar config check FILE` checks a file, `isobar config show [FILE]` prints all settings, "
      "`isobar config show --basic [FILE]` only the basic ones.",
      out);
  out += source;
  append_audience(settings, Audience::kBasic, "======== Basic settings: set these first ========", origins,
                  out);
  if (shown == Shown::kAll) {
    append_audience(settings, Audience::kExpert,
                    "======== Expert settings: the defaults suit most robots ========", origins, out);
  }
  return with_end_mark(out);
}

}  // namespace

std::string show_config(const Config& config, Shown shown) { return show(config, {}, shown, ""); }

std::string show_config(const LoadedConfig& loaded, Shown shown) {
  std::string source = "# Hash " + config_hash(loaded.config) + ", from";
  for (const std::string& file : loaded.files) source += " " + file;
  return show(loaded.config, loaded.origins, shown, source + "\n");
}

std::string settings_in_force(const Config& config) {
  const std::string shown = show_config(config);
  std::string settings;
  std::string_view rest = shown;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
    if (rest.front() != '#' && rest.front() != '\n') settings += rest.substr(0, end);
    rest.remove_prefix(end);
  }
  return settings;
}

std::string show_compensation(const CompensationConfig& compensation, const std::string& comment) {
  CompensationConfig copy = compensation;
  std::vector<Setting> settings;
  add_compensation_settings("compensation", UsedBy::kEveryRole, copy, settings);
  std::string out;
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    append_comment(std::string_view(comment).substr(begin, end - begin), out);
    begin = end + 1;
  }
  out += "\n";
  append_comment(section_doc("compensation"), out);
  out += "[compensation]\n";
  for (const Setting& setting : settings) {
    append_setting(setting, setting.name(), {}, out);
    out += "\n";
  }
  out.pop_back();
  return out;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "tools/overridden_settings.hpp"

#include <map>
#include <sstream>

#include "config/config_io.hpp"

namespace isobar::tools {

namespace {

/// The values of a configuration by key, as TOML writes them.
std::map<std::string, std::string> values_by_key(const Config& config) {
  constexpr std::string_view kEquals = " = ";
  std::map<std::string, std::string> values;
  std::string section;
  std::istringstream lines(settings_in_force(config));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) section = line.substr(1, line.find(']') - 1) + ".";
    const std::size_t equals = line.find(kEquals);
    if (equals != std::string::npos)
      values[section + line.substr(0, equals)] = line.substr(equals + kEquals.size());
  }
  return values;
}

}  // namespace

std::vector<std::string> overridden_settings(const LoadedConfig& loaded, const Config& used) {
  const auto wanted = values_by_key(loaded.config);
  const auto taken = values_by_key(used);
  std::vector<std::string> sentences;
  for (const auto& [key, origin] : loaded.origins) {
    const auto before = wanted.find(key);
    const auto after = taken.find(key);
    if (before == wanted.end() || after == taken.end() || before->second == after->second) continue;
    sentences.push_back(origin.file + ":" + std::to_string(origin.line) + ": " + key + " = " +
                        before->second + " is not used: the recording has " + after->second);
  }
  return sentences;
}

}  // namespace isobar::tools

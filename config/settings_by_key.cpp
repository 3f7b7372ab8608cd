// SPDX-License-Identifier: BSD-3-Clause
#include "config/settings_by_key.hpp"

#include <sstream>
#include <string_view>

#include "config/config_io.hpp"

namespace isobar {

std::map<std::string, std::string> settings_by_key(const Config& config) {
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

}  // namespace isobar

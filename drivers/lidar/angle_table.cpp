// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar/angle_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include "core/errors.hpp"
#include "core/printable_text.hpp"

namespace isobar {
namespace {

/// The numbers of a line; nothing when a field is none.
std::optional<std::vector<double>> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    std::string_view field = line.substr(0, comma);
    while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\r')) field.remove_suffix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
    numbers.push_back(value);
    if (comma == line.size()) return numbers;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

std::vector<std::uint8_t> AngleTable::rings() const {
  std::vector<std::uint8_t> rings;
  for (const double elevation : elevation_deg) {
    rings.push_back(static_cast<std::uint8_t>(std::count_if(
        elevation_deg.begin(), elevation_deg.end(), [=](double other) { return other < elevation; })));
  }
  return rings;
}

std::string broken_rule(const AngleTable& table, std::size_t channels) {
  constexpr double kMostAzimuthDeg = 30.0;
  if (table.channels() != channels) {
    return "must hold " + std::to_string(channels) + " channels (holds " + std::to_string(table.channels()) +
           ")";
  }
  for (std::size_t i = 0; i < channels; ++i) {
    const std::string channel = "channel " + std::to_string(i + 1) + ": ";
    if (!(std::abs(table.elevation_deg[i]) < 90.0)) return channel + "elevation must lie within -90 … 90 deg";
    if (!(std::abs(table.azimuth_deg[i]) <= kMostAzimuthDeg)) {
      return channel + "azimuth must lie within -30 … 30 deg";
    }
    for (std::size_t before = 0; before < i; ++before) {
      if (table.elevation_deg[before] == table.elevation_deg[i]) {
        return channel + "has the elevation of channel " + std::to_string(before + 1);
      }
    }
  }
  return {};
}

AngleTable read_angle_file(const std::string& file, std::size_t channels) {
  const std::string name = printable(file);
  std::ifstream in(file);
  if (!in)
    throw ConfigError(name + ": cannot be read; lidar.calibration_file must name a file of beam angles");
  AngleTable table;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    const std::string place = name + ":" + std::to_string(number) + ": ";
    const auto numbers = numbers_of(line);
    if (!numbers && table.channels() == 0) continue;  // the header
    if (!numbers || (numbers->size() != 2 && numbers->size() != 3)) {
      throw ConfigError(place + "must be `channel,elevation,azimuth` or `elevation,azimuth` in degrees");
    }
    if (numbers->size() == 3 && (*numbers)[0] != static_cast<double>(table.channels() + 1)) {
      throw ConfigError(place + "channel must be " + std::to_string(table.channels() + 1) + ", in order");
    }
    table.elevation_deg.push_back((*numbers)[numbers->size() - 2]);
    table.azimuth_deg.push_back(numbers->back());
  }
  if (const std::string rule = broken_rule(table, channels); !rule.empty())
    throw ConfigError(name + ": " + rule);
  return table;
}

}  // namespace isobar

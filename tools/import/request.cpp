// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "run/text/number_text.hpp"

namespace isobar::tools {
namespace {

/// The texts between commas.
std::vector<std::string> numbers_of(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

}  // namespace

std::map<std::string, Mount> ImportRequest::mounts() const {
  constexpr double kMostLeverM = 100.0;
  constexpr double kMostAngleDeg = 360.0;
  std::map<std::string, Mount> mounts;
  for (const std::string& text : mount_texts) {
    const std::size_t equals = text.find('=');
    const std::string sensor = text.substr(0, equals);
    const bool is_known = sensor == "lidar" || sensor == "imu" || sensor == "barometer";
    const auto numbers =
        equals == std::string::npos ? std::vector<std::string>{} : numbers_of(text.substr(equals + 1));
    std::array<double, 6> values{};
    bool good = is_known && (numbers.size() == 3 || numbers.size() == values.size());
    for (std::size_t i = 0; good && i < numbers.size(); ++i) {
      good = text::parse_number(numbers[i], values.at(i)) &&
             std::abs(values.at(i)) <= (i < 3 ? kMostLeverM : kMostAngleDeg);
    }
    if (!good) {
      throw UsageError(
          "--mount: must be lidar=, imu= or barometer= with x,y,z,roll,pitch,yaw in metres and degrees, "
          "such as lidar=0.1,0,0.4,0,0,0 (got " +
          printable(text) + ")");
    }
    mounts[sensor] = {{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
  }
  return mounts;
}

std::vector<std::string> table_of(const ImportReport& report) {
  std::array<std::size_t, 2> widths{5, 4};
  for (const ImportRow& row : report.rows) {
    widths[0] = std::max(widths[0], printable(row.name).size());
    widths[1] = std::max(widths[1], printable(row.type).size());
  }
  const auto padded = [](std::string text, std::size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text;
  };
  std::vector<std::string> lines;
  lines.push_back(padded("topic", widths[0]) + "  " + padded("type", widths[1]) +
                  "     count      rate  becomes");
  for (const ImportRow& row : report.rows) {
    std::array<char, 48> figures{};
    if (row.rate_hz > 0.0) {
      std::snprintf(figures.data(), figures.size(), "%10llu %6.1f Hz",
                    static_cast<unsigned long long>(row.count), row.rate_hz);
    } else {
      std::snprintf(figures.data(), figures.size(), "%10llu          ",
                    static_cast<unsigned long long>(row.count));
    }
    lines.push_back(padded(printable(row.name), widths[0]) + "  " + padded(printable(row.type), widths[1]) +
                    figures.data() + "  " + row.becomes);
  }
  return lines;
}

}  // namespace isobar::tools

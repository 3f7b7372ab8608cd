// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/tum_row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/text/number_text.hpp"

namespace isobar::text {
namespace {

/// A stamp beyond this does not fit 64 bits of nanoseconds.
constexpr double kLargestStampS = 9.2e9;

/// The next word of the line, which is shortened by it; empty at the end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kSeparators = " \t,";
  line.remove_prefix(std::min(line.find_first_not_of(kSeparators), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kSeparators));
  line.remove_prefix(word.size());
  return word;
}

std::int64_t parse_stamp(std::string_view word, const TextLines& lines) {
  std::int64_t stamp_ns = 0;
  if (parse_seconds(word, stamp_ns)) {
    return stamp_ns;
  }
  double stamp_s = 0.0;  // exponent notation: to the resolution of a double
  if (!parse_number(word, stamp_s) || !(std::abs(stamp_s) <= kLargestStampS)) {
    throw DataError(lines.place() + "the time '" + std::string(word) + "' is not a number of seconds");
  }
  return std::llround(stamp_s * 1e9);
}

TumRow parse_row(std::string_view line, const TextLines& lines) {
  TumRow row;
  row.stamp_ns = parse_stamp(next_word(line), lines);
  std::array<double, 7> values{};
  for (double& value : values) {
    const std::string_view word = next_word(line);
    if (word.empty()) {
      throw DataError(lines.place() + "a pose has eight numbers: t x y z qx qy qz qw");
    }
    if (!parse_number(word, value) || !std::isfinite(value)) {
      throw DataError(lines.place() + "'" + std::string(word) + "' is not a finite number");
    }
  }
  if (!next_word(line).empty()) {
    throw DataError(lines.place() + "more than the eight numbers t x y z qx qy qz qw");
  }
  row.position_m = {values[0], values[1], values[2]};
  row.attitude = Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
  if (!kPlausibleQuaternionNorm.holds(row.attitude.norm())) {
    throw DataError(lines.place() + "qx qy qz qw is not a unit quaternion");
  }
  row.attitude.normalize();
  return row;
}

}  // namespace

std::optional<TumRow> next_tum_row(TextLines& lines) {
  std::string_view line;
  while (lines.next(line)) {
    if (lines.too_long()) {
      throw DataError(lines.too_long_message());
    }
    const std::string_view content = trimmed(line);
    if (!content.empty() && content.front() != '#') {
      return parse_row(content, lines);
    }
  }
  return std::nullopt;
}

void append_tum_row(const TumRow& row, std::string& text) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  const Eigen::Vector3d& p = row.position_m;
  const Eigen::Quaterniond& q = row.attitude;
  // Integer seconds and nanoseconds: a double resolves a date of today to 0.2 us only.
  const long long seconds = std::llabs(row.stamp_ns / kNsPerS);
  const long long nanoseconds = std::llabs(row.stamp_ns % kNsPerS);
  std::array<char, 4096> line;  // holds seven numbers of 1e308
  const int length = std::snprintf(
      line.data(), line.size(), "%s%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
      row.stamp_ns < 0 ? "-" : "", seconds, nanoseconds, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  text.append(line.data(), static_cast<std::size_t>(length));
}

}  // namespace isobar::text

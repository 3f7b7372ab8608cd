// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "run/recording/pressure_header.hpp"

namespace isobar::recording {

/// Unit of a time column.
struct TimeUnit {
  const char* name;
  double ns;
};

/// A field with a decimal point for its decimal comma: "1.013,25" is 1013.25.
[[nodiscard]] std::string with_decimal_point(std::string_view text);

/// Parser of the time of a log's rows: dates as text, times of day, or numbers in the unit that is named or that gives a
/// date of this century.
class TimeColumn {
 public:
  /// @param unit of the command line, empty: none
  /// @throws UsageError when `unit` is not known
  TimeColumn(const PressureHeader& header, const std::string& unit);

  /// Takes the next row.
  /// @param rest of the second column
  /// @return false when the text is not a time
  /// @throws DataError naming `place` when the unit is ambiguous
  bool parse(std::string_view text, std::string_view rest, const std::string& place, std::int64_t& stamp_ns);

  /// A sentence about the column and what was found in it.
  [[nodiscard]] std::string note() const;

 private:
  bool parse_pair(std::string_view text, std::string_view rest, std::int64_t& stamp_ns);
  bool parse_text(std::string_view text, std::int64_t& stamp_ns);
  bool parse_number(const std::string& text, const std::string& place, std::int64_t& stamp_ns);
  std::int64_t on_its_day(std::int64_t of_day_ns);
  void use(const TimeUnit& unit, const char* reason);
  void guess(double number, const std::string& place);

  std::string name_;
  std::string rest_name_;
  TimeLayout layout_;
  const TimeUnit* unit_ = nullptr;
  const char* reason_ = "";
  bool unit_is_chosen_ = false;  // on the command line
  bool is_date_ = false;
  bool is_time_of_day_ = false;
  std::int64_t day_ = 0;  // of the last time of day
  std::int64_t last_of_day_ns_ = 0;
};

}  // namespace isobar::recording

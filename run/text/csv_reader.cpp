// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/csv_reader.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/errors.hpp"
#include "run/text/number_text.hpp"

namespace isobar::text {

namespace {

/// End of the first field. A separator between quotation marks divides nothing (RFC 4180).
std::size_t end_of_field(std::string_view line, char separator) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string_view::npos || line[begin] != '"') return line.find(separator);
  std::size_t close = line.find('"', begin + 1);
  while (close != std::string_view::npos && line.substr(close + 1).starts_with('"')) {
    close = line.find('"', close + 2);  // a doubled mark stands for one
  }
  return line.find(separator, close == std::string_view::npos ? 0 : close);
}

}  // namespace

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const auto end = end_of_field(line, separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) {
      return;
    }
    line.remove_prefix(end + 1);
  }
}

CsvReader::CsvReader(TextLines lines, const std::vector<std::string_view>& required,
                     const std::vector<std::string_view>& optional, const CsvFormat& format)
    : lines_(std::move(lines)), format_(format), names_(required.begin(), required.end()) {
  names_.insert(names_.end(), optional.begin(), optional.end());
  find_columns(required.size());
}

void CsvReader::find_columns(std::size_t required) {
  std::string_view header;
  while (lines_.line_number() < format_.header_line) {
    if (!lines_.next(header)) {
      throw DataError(lines_.name() + ":1: is empty, must start with a line that names the columns");
    }
  }
  split_fields(header, format_.separator, fields_);
  columns_ = fields_.size();
  for (const std::string& name : names_) {
    const auto found = std::find(fields_.begin(), fields_.end(), name);
    const bool absent = found == fields_.end();
    if (absent && position_.size() < required) {
      throw DataError(lines_.place() + "column '" + name + "' is missing");
    }
    if (!absent && std::find(found + 1, fields_.end(), name) != fields_.end()) {
      throw DataError(lines_.place() + "column '" + name + "' is named twice");
    }
    position_.push_back(absent ? kAbsent : static_cast<std::size_t>(found - fields_.begin()));
  }
}

CsvReader::Row CsvReader::next() {
  std::string_view line;
  while (lines_.next(line)) {
    if (lines_.too_long()) {
      return Row::kBad;
    }
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') {
      continue;
    }
    split_fields(line, format_.separator, fields_);
    return fields_.size() == columns_ ? Row::kGood : Row::kBad;
  }
  return Row::kEnd;
}

bool CsvReader::next_row() {
  const Row row = next();
  if (row == Row::kBad) {
    throw DataError(bad_row_message());
  }
  return row == Row::kGood;
}

std::int64_t CsvReader::int64(std::size_t column) const {
  std::int64_t value = 0;
  if (!parse_number(field(column), value)) {
    fail(column, "is not a whole number");
  }
  return value;
}

double CsvReader::number_or_nan(std::size_t column) const {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (!field(column).empty() && !parse_number(field(column), value)) {
    fail(column, "is not a number");
  }
  return value;
}

void CsvReader::fail(std::size_t column, const char* rule) const {
  throw DataError(lines_.place() + names_[column] + ": '" + std::string(field(column)) + "' " + rule);
}

std::string_view CsvReader::field(std::size_t column) const {
  return has(column) ? fields_[position_[column]] : std::string_view{};
}

std::string CsvReader::bad_row_message() const {
  if (lines_.too_long()) {
    return lines_.too_long_message();
  }
  return lines_.place() + "has " + std::to_string(fields_.size()) + " fields, the header names " +
         std::to_string(columns_);
}

}  // namespace isobar::text

// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/csv_reader.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "run/recording/number_text.hpp"

namespace isobar::recording {

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const auto end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) {
      return;
    }
    line.remove_prefix(end + 1);
  }
}

CsvReader::CsvReader(const std::filesystem::path& file, const std::vector<std::string_view>& required,
                     const std::vector<std::string_view>& optional, const CsvFormat& format)
    : lines_(file), format_(format) {
  find_columns(required, optional);
}

void CsvReader::find_columns(const std::vector<std::string_view>& required,
                             const std::vector<std::string_view>& optional) {
  std::string_view header;
  while (lines_.line_number() < format_.header_line) {
    if (!lines_.next(header)) {
      throw DataError(lines_.file_name() + ":1: is empty, must start with a line that names the columns");
    }
  }
  split_fields(header, format_.separator, fields_);
  columns_ = fields_.size();
  const auto locate = [this](std::string_view name) {
    if (std::count(fields_.begin(), fields_.end(), name) > 1) {
      throw DataError(lines_.place() + "column '" + std::string(name) + "' stands twice");
    }
    const auto found = std::find(fields_.begin(), fields_.end(), name);
    return found == fields_.end() ? kAbsent : static_cast<std::size_t>(found - fields_.begin());
  };
  for (const std::string_view name : required) {
    position_.push_back(locate(name));
    if (position_.back() == kAbsent) {
      throw DataError(lines_.place() + "column '" + std::string(name) + "' is missing");
    }
  }
  for (const std::string_view name : optional) {
    position_.push_back(locate(name));
  }
}

CsvReader::Row CsvReader::next() {
  std::string_view line;
  while (lines_.next(line)) {
    if (lines_.too_long()) {
      return Row::kBad;
    }
    if (trimmed(line).empty()) {
      continue;
    }
    split_fields(line, format_.separator, fields_);
    return fields_.size() == columns_ ? Row::kGood : Row::kBad;
  }
  return Row::kEnd;
}

std::string_view CsvReader::field(std::size_t column) const {
  return has(column) ? fields_[position_[column]] : std::string_view{};
}

std::string CsvReader::bad_row_message() const {
  if (lines_.too_long()) {
    return lines_.place() + "the line is longer than " + std::to_string(TextLines::kMaxLineBytes) + " bytes";
  }
  return lines_.place() + "has " + std::to_string(fields_.size()) + " fields, the header names " +
         std::to_string(columns_);
}

}  // namespace isobar::recording

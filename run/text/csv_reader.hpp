// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "run/text/text_lines.hpp"

namespace isobar::text {

/// Layout of a CSV file; the defaults are those of the project's own files.
struct CsvFormat {
  char separator = ',';
  std::size_t header_line = 1;  ///< the line that names the columns
};

/// Splits a line into fields; blanks and quotation marks around a field are removed, separators between quotation
/// marks are kept.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// CSV reader. The first line (or another, see CsvFormat) names the columns, in any order; unknown columns,
/// blank rows and rows that start with '#' are ignored. A column is known by its index in `required` followed
/// by `optional`.
class CsvReader {
 public:
  /// Finds the columns.
  /// @throws DataError "name:line: rule" when there is no header, a required column is missing or a known
  ///           column is named twice
  CsvReader(TextLines lines, const std::vector<std::string_view>& required,
            const std::vector<std::string_view>& optional = {}, const CsvFormat& format = {});

  enum class Row { kGood, kBad, kEnd };
  /// Moves to the next row. kBad: another number of fields than the header, or too long a line.
  Row next();
  /// Moves to the next row; false at the end.
  /// @throws DataError "name:line: rule" when the row is bad
  bool next_row();

  /// Text of a column in the current row; empty where the file lacks the column. Valid until the next row.
  [[nodiscard]] std::string_view field(std::size_t column) const;
  [[nodiscard]] bool has(std::size_t column) const { return position_[column] != kAbsent; }
  /// Whole number of a column in the current row.
  /// @throws DataError "name:line: column: rule" when the field is not a whole number of 64 bits
  [[nodiscard]] std::int64_t int64(std::size_t column) const;
  /// Number of a column in the current row; NaN where the file lacks the column or the field is empty.
  /// @throws DataError "name:line: column: rule" when the field is not a number
  [[nodiscard]] double number_or_nan(std::size_t column) const;

  /// See TextLines.
  void skip_to_last(std::uint64_t bytes) { lines_.skip_to_last(bytes); }

  [[nodiscard]] const TextLines& lines() const { return lines_; }
  /// Why the current row is bad: "name:line: rule".
  [[nodiscard]] std::string bad_row_message() const;

 private:
  static constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);
  void find_columns(std::size_t required);
  [[noreturn]] void fail(std::size_t column, const char* rule) const;

  TextLines lines_;
  CsvFormat format_;
  std::vector<std::string> names_;     // of the known columns
  std::vector<std::size_t> position_;  // of each known column in the file
  std::vector<std::string_view> fields_;
  std::size_t columns_ = 0;
};

}  // namespace isobar::text

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "run/recording/text_lines.hpp"

namespace isobar::recording {

/// How a CSV file differs from the project's own.
struct CsvFormat {
  char separator = ',';
  std::size_t header_line = 1;  ///< the line that names the columns
};

/// Splits a line; fields come without blanks and quotation marks around them.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Reads a CSV file whose first line (or another, see CsvFormat) names the columns, in any order; unknown
/// columns are ignored.
class CsvReader {
 public:
  /// Finds the columns. Throws DataError "file:line: …" that names a required column which is missing or
  /// stands twice.
  CsvReader(const std::filesystem::path& file, const std::vector<std::string_view>& required,
            const std::vector<std::string_view>& optional = {}, const CsvFormat& format = {});

  enum class Row { kGood, kBad, kEnd };
  /// Goes to the next row that is not blank. kBad: another number of fields than the header, or far too long.
  Row next();

  /// Text of a column in the current row, by its place in `required` followed by `optional`; empty for an
  /// optional column that the file does not have. Valid until next().
  [[nodiscard]] std::string_view field(std::size_t column) const;
  [[nodiscard]] bool has(std::size_t column) const { return position_[column] != kAbsent; }

  /// See TextLines.
  void skip_to_last(std::uint64_t bytes) { lines_.skip_to_last(bytes); }

  [[nodiscard]] const TextLines& lines() const { return lines_; }
  /// Why the row is bad: "file:line: rule".
  [[nodiscard]] std::string bad_row_message() const;

 private:
  static constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);
  void find_columns(const std::vector<std::string_view>& required,
                    const std::vector<std::string_view>& optional);

  TextLines lines_;
  CsvFormat format_;
  std::vector<std::size_t> position_;  // of each known column in the file
  std::vector<std::string_view> fields_;
  std::size_t columns_ = 0;
};

}  // namespace isobar::recording

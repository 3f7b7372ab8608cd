// SPDX-License-Identifier: BSD-3-Clause
// Reading of small text tables that were already loaded: lines, words, numbers, CSV columns by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::evaluation {

/// Hands out a text's lines without their line ends (LF or CRLF) and without a leading UTF-8 byte-order mark.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  /// The next line, or nothing at the end of the text.
  std::optional<std::string_view> next();
  /// Number of the line that next() returned last, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_number_; }

 private:
  std::string_view text_;
  std::size_t line_number_ = 0;
};

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// The cells of a CSV line without quoting, blanks around them taken off.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

/// A decimal number, "nan" and "inf" included; nothing if any other character is in the way.
std::optional<double> parse_double(std::string_view word);

/// A whole number that fits 64 bits.
std::optional<std::int64_t> parse_int64(std::string_view word);

/// CSV table with one header line whose columns may stand in any order; unknown columns are ignored.
class CsvReader {
 public:
  /// `name` is what errors call the text. Throws DataError if there is no header line or a name stands twice.
  CsvReader(std::string_view text, std::string name);

  /// Index of a column, or nothing.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view title) const;
  /// Throws DataError "name:1: rule" if the column is missing.
  [[nodiscard]] std::size_t required_column(std::string_view title) const;

  /// Moves to the next line that is not blank and no '#' comment. Throws DataError "name:line: rule" if it
  /// has another number of cells than the header.
  bool next_row();
  [[nodiscard]] std::string_view cell(std::size_t column) const { return cells_[column]; }
  /// Throws DataError naming line and column if the cell is no whole number.
  [[nodiscard]] std::int64_t int64(std::size_t column) const;
  /// NaN for a missing column or an empty cell. Throws DataError naming line and column if it is no number.
  [[nodiscard]] double number_or_nan(std::optional<std::size_t> column) const;
  /// "name:line: " of the current row.
  [[nodiscard]] std::string where() const;

 private:
  LineReader lines_;
  std::string name_;
  std::string_view header_line_;
  std::vector<std::string_view> header_;
  std::vector<std::string_view> cells_;
};

}  // namespace isobar::evaluation

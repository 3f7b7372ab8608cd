// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/text_table.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "core/errors.hpp"

namespace isobar::evaluation {

namespace {

template <typename Number>
std::optional<Number> parse_whole_word(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  const char* const last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value);
  if (error != std::errc() || end != last) return std::nullopt;
  return value;
}

}  // namespace

LineReader::LineReader(std::string_view text) : text_(text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

std::optional<std::string_view> LineReader::next() {
  if (text_.empty()) return std::nullopt;
  const std::size_t end = text_.find('\n');
  std::string_view line = text_.substr(0, end);
  text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++line_number_;
  return line;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> parse_double(std::string_view word) { return parse_whole_word<double>(word); }

std::optional<std::int64_t> parse_int64(std::string_view word) {
  return parse_whole_word<std::int64_t>(word);
}

CsvReader::CsvReader(std::string_view text, std::string name) : lines_(text), name_(std::move(name)) {
  const std::optional<std::string_view> line = lines_.next();
  if (!line || trimmed(*line).empty()) throw DataError(name_ + ":1: has no header line");
  header_line_ = *line;
  split_cells(header_line_, header_);
  for (auto title = header_.begin(); title != header_.end(); ++title) {
    if (std::count(header_.begin(), header_.end(), *title) > 1) {
      throw DataError(name_ + ":1: the column '" + std::string(*title) + "' stands twice");
    }
  }
}

std::optional<std::size_t> CsvReader::column(std::string_view title) const {
  const auto found = std::find(header_.begin(), header_.end(), title);
  if (found == header_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.begin());
}

std::size_t CsvReader::required_column(std::string_view title) const {
  const std::optional<std::size_t> index = column(title);
  if (!index) throw DataError(name_ + ":1: the column '" + std::string(title) + "' is missing");
  return *index;
}

bool CsvReader::next_row() {
  while (const std::optional<std::string_view> line = lines_.next()) {
    const std::string_view content = trimmed(*line);
    if (content.empty() || content.front() == '#') continue;
    split_cells(*line, cells_);
    if (cells_.size() == header_.size()) return true;
    throw DataError(where() + std::to_string(cells_.size()) + " cells under " +
                    std::to_string(header_.size()) + " columns");
  }
  return false;
}

std::int64_t CsvReader::int64(std::size_t column) const {
  const std::optional<std::int64_t> value = parse_int64(cell(column));
  if (value) return *value;
  throw DataError(where() + std::string(header_[column]) + ": '" + std::string(cell(column)) +
                  "' is not a whole number");
}

double CsvReader::number_or_nan(std::optional<std::size_t> column) const {
  if (!column || cell(*column).empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = parse_double(cell(*column));
  if (value) return *value;
  throw DataError(where() + std::string(header_[*column]) + ": '" + std::string(cell(*column)) +
                  "' is not a number");
}

std::string CsvReader::where() const { return name_ + ":" + std::to_string(lines_.line_number()) + ": "; }

}  // namespace isobar::evaluation

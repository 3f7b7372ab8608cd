// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "run/text/text_source.hpp"

namespace isobar::text {

/// Line reader in bounded memory. A line ends with \n or \r\n (optional on the last one); a UTF-8 byte-order
/// mark is skipped, and files are read as TextSource describes. A line longer than kMaxLineBytes reads as an empty line with too_long() set.
class TextLines {
 public:
  static constexpr std::size_t kMaxLineBytes = 4096;

  /// Opens a file.
  /// @throws DataError when the file is missing, a folder or cannot be read
  explicit TextLines(const std::filesystem::path& file);
  /// Reads a text that is loaded already.
  /// @param name names the text in errors
  TextLines(std::string_view text, std::string name);

  /// The next line without its line end, valid until the next call; false at the end of the text.
  bool next(std::string_view& line);

  /// Skips ahead to the first line that begins in the last `bytes` of the file; does nothing when already
  /// past it. Line numbers then count from there.
  void skip_to_last(std::uint64_t bytes);

  /// The current line is the last one and has no line end: it may be cut.
  [[nodiscard]] bool without_end() const { return without_end_; }
  [[nodiscard]] bool too_long() const { return too_long_; }
  /// "name:line: rule" for a line that is too long.
  [[nodiscard]] std::string too_long_message() const {
    return place() + "the line is longer than " + std::to_string(kMaxLineBytes) + " bytes";
  }
  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// "name:line: " of the current line.
  [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(line_number_) + ": "; }
  /// Of the file as it lies on the disk.
  [[nodiscard]] std::uint64_t bytes_read() const { return source_ == nullptr ? 0 : source_->bytes_read(); }
  /// "name: rule" when a compressed file ended early; empty: it did not, or has not yet.
  [[nodiscard]] std::string damage() const;

 private:
  bool refill();

  std::string name_;
  std::unique_ptr<TextSource> source_;  // nullptr: the whole text is in buffer_
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool too_long_ = false;
  bool without_end_ = false;
  bool at_end_ = false;
};

}  // namespace isobar::text

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::recording {

/// Reads a text file line by line in bounded memory. Ends of line may be \n or \r\n, the last may lack, a
/// byte order mark is skipped. A line longer than kMaxLineBytes comes as an empty line with too_long() set.
class TextLines {
 public:
  static constexpr std::size_t kMaxLineBytes = 4096;

  /// Throws DataError when the file is missing, a folder or cannot be read.
  explicit TextLines(const std::filesystem::path& file);

  /// The next line without its end; valid until the next call.
  bool next(std::string_view& line);

  /// Goes to the first line that begins in the last `bytes` of the file, unless that is behind already. Line
  /// numbers then count from there.
  void skip_to_last(std::uint64_t bytes);

  [[nodiscard]] bool too_long() const { return too_long_; }
  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  [[nodiscard]] const std::string& file_name() const { return name_; }
  /// "file:line: "
  [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(line_number_) + ": "; }
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  bool refill();

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  std::uint64_t bytes_read_ = 0;
  bool too_long_ = false;
  bool at_end_ = false;
};

}  // namespace isobar::recording

// SPDX-License-Identifier: BSD-3-Clause
// Small file helpers of the report tools: a whole file as text, and a buffered file that says what went
// wrong.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace isobar::files {

/// The whole file. Throws DataError naming the file if it cannot be read, is a directory, or has more than
/// `max_bytes` (a guard against being pointed at a device or at the wrong file).
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes = std::size_t{1} << 31);

/// Writes the whole file. Throws ServiceError naming the file if that fails.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// A file being written, with a large buffer. Every failure throws ServiceError naming the file.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path file);

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void seek(long offset);
  /// Flushes and closes; nothing may be written afterwards. The destructor closes without a word.
  void close();
  [[nodiscard]] bool is_open() const { return file_ != nullptr; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace isobar::files

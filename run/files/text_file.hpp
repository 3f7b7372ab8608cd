// SPDX-License-Identifier: BSD-3-Clause
// Whole text files, and a buffered output file. Every error names the file.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace isobar::files {

/// The content of a file.
/// @param max_bytes guards against endless devices and wrong files
/// @throws DataError naming the file when it cannot be read, is a directory, or is larger than `max_bytes`
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes = std::size_t{1} << 31);

/// Creates or replaces a file.
/// @throws ServiceError naming the file when it cannot be written
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Replaces a file as a whole: whenever the process or the machine ends, either the old or the new content is
/// there.
/// @throws ServiceError naming the file when it cannot be written; the old content stays
void replace_file(const std::filesystem::path& file, std::string_view content);

/// A file open for writing, with a large buffer.
/// @throws ServiceError naming the file when any operation fails
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path file);

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void seek(long offset);
  /// Flushes and closes; later writes throw. The destructor closes, too, but cannot report errors.
  void close();
  /// Waits until the content is on the disk; a pipe or a device has none.
  void sync();
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

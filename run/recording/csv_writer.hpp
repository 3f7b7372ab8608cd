// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace isobar::recording {

/// Buffered text file that reports write errors. Hands whole texts to the kernel: what a killed process leaves
/// ends where a write() ended.
class TextFile {
 public:
  /// Creates or truncates the file.
  /// @throws DataError when it cannot be opened
  explicit TextFile(const std::filesystem::path& file);
  /// A failure is kept for close().
  /// @throws DataError when the file is closed
  void write(std::string_view text);
  /// Hands everything written so far to the kernel.
  /// @throws DataError when any write failed
  void flush();
  /// Flushes and closes.
  /// @throws DataError when any write failed
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void flush_buffer();

  std::string name_;
  std::unique_ptr<char[]> buffer_;  // NOLINT(modernize-avoid-c-arrays): of file_, must outlive it
  std::unique_ptr<std::FILE, Closer> file_;
  std::size_t pending_ = 0;  // bytes in the buffer
  int error_ = 0;            // errno of the first failed write
};

/// CSV row of numbers, each in the shortest text that reads back as the same bits.
class CsvRow {
 public:
  CsvRow& add(double value);
  CsvRow& add(std::int64_t value);
  /// The row with its newline.
  std::string_view finish();

 private:
  void separate();

  static constexpr std::size_t kCapacity = 512;  // 16 numbers of 32 bytes
  char text_[kCapacity];                         // NOLINT(modernize-avoid-c-arrays)
  std::size_t used_ = 0;
};

}  // namespace isobar::recording

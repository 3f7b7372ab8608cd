// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar::files {

/// Whether the files of a run begin or go on.
enum class Start : std::uint8_t {
  kNew,       ///< files of an earlier run are replaced
  kContinue,  ///< files of an earlier run are appended to
};

/// Text file that grows by whole lines: whenever the process or the machine ends, it holds whole lines only,
/// but for the last line after a power cut. A file that was deleted or moved is created anew.
///
/// A failed flush() keeps the lines; the next one tries again, so that writing resumes when the disk has room.
/// Not thread-safe.
class LineFile {
 public:
  /// Lines kept while the disk refuses; newer ones are dropped and counted.
  static constexpr std::size_t kMaxPendingBytes = std::size_t{4} << 20;

  /// @param header first line of a new file, with its line end
  /// @throws ServiceError naming the file when a new one cannot be opened; where one is continued, flush() tries
  ///         again
  LineFile(std::filesystem::path file, std::string header, Start start);

  /// Takes a line, with its line end, to be written by flush().
  void add(std::string_view line);
  /// Writes the lines with one call of write(2).
  /// @throws ServiceError naming the file; whole lines that were written stay, the others are kept
  void flush();
  /// Waits until the lines are on the disk (fdatasync); does nothing when none are new.
  /// @throws ServiceError naming the file
  void sync();

  [[nodiscard]] std::size_t pending_bytes() const { return pending_.size(); }
  [[nodiscard]] std::uint64_t dropped_lines() const { return dropped_; }
  /// Bytes of an incomplete last line, left by a power cut, which the constructor removed.
  [[nodiscard]] std::uint64_t removed_bytes() const { return removed_; }

 private:
  void open(bool replace);
  void remove_incomplete_line();
  void follow_path();
  [[noreturn]] void fail(const char* what);

  std::filesystem::path path_;
  std::string header_;
  FileDescriptor file_;  ///< none after a failure: the next flush() opens the file again
  std::string pending_;
  std::uint64_t dropped_ = 0;
  std::uint64_t removed_ = 0;
  bool unsynced_ = false;
};

}  // namespace isobar::files

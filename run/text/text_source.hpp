// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run/text/gzip_file.hpp"

namespace isobar::text {

/// The bytes of a text file as UTF-8: files in UTF-16 (either byte order, told by the byte-order mark, as
/// spreadsheets write them) are converted, compressed ones are decompressed; any other passes as it is.
class TextSource {
 public:
  /// @throws DataError when the file is missing, a folder or cannot be read
  explicit TextSource(const std::filesystem::path& file);

  /// Reads up to `size` bytes; 0 at the end.
  /// @param size at least 8
  std::size_t read(char* to, std::size_t size);
  /// See GzipFile. In UTF-16 `bytes` and `unread` count bytes of the file, and a unit is never divided.
  bool skip_to_last(std::uint64_t bytes, std::uint64_t unread);

  [[nodiscard]] std::uint64_t bytes_read() const { return file_.bytes_read(); }
  [[nodiscard]] const std::string& damage() const { return file_.damage(); }

 private:
  enum class Encoding : std::uint8_t { kBytes, kUtf16Little, kUtf16Big };
  [[nodiscard]] std::uint32_t unit_at(std::size_t index) const;
  bool fill();
  static std::size_t put_utf8(std::uint32_t code, char* to);

  GzipFile file_;
  Encoding encoding_ = Encoding::kBytes;
  std::vector<char> raw_;      // of UTF-16: bytes not converted yet
  std::size_t raw_count_ = 0;  // of raw_
};

}  // namespace isobar::text

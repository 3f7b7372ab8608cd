// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace isobar::imports {

/// Largest record, chunk or message that is read, also after decompression [bytes].
inline constexpr std::uint64_t kMostRecordBytes = std::uint64_t{512} << 20U;

/// A file of a known size, read forward.
class FileBytes {
 public:
  /// @throws DataError when the file is missing, a folder, or cannot be read
  explicit FileBytes(const std::filesystem::path& file);

  /// Reads exactly `to.size()` bytes; false where the file is shorter: the position is then unspecified.
  bool read(std::span<std::uint8_t> to);
  /// Reads `size` bytes into a buffer that grows with what is there.
  /// @return false where the file is shorter, or `size` exceeds kMostRecordBytes
  bool read(std::uint64_t size, std::vector<std::uint8_t>& to);
  bool skip(std::uint64_t size);

  [[nodiscard]] std::uint64_t position() const { return position_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint64_t left() const { return size_ - position_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// "FILE: byte 8123: ".
  [[nodiscard]] std::string place(std::uint64_t at) const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

/// The first bytes of a file, fewer in a shorter one; none of a file that cannot be read.
[[nodiscard]] std::string head_of(const std::filesystem::path& file, std::size_t bytes);

}  // namespace isobar::imports

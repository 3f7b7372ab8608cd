// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;

namespace isobar::text {

/// Byte reader of a file that may be compressed with gzip (RFC 1952), told by its first bytes, not by its name.
/// Memory is bounded whatever the file holds.
class GzipFile {
 public:
  /// Bytes that head() shows.
  static constexpr std::size_t kHeadBytes = 4;

  /// @throws DataError when the file is missing, a folder or cannot be read
  explicit GzipFile(const std::filesystem::path& file);
  ~GzipFile();
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  /// Reads up to `size` bytes, decompressed; 0 at the end, also where a compressed file is damaged.
  std::size_t read(char* to, std::size_t size);

  /// The first bytes, decompressed; fewer in a shorter file. They are still read by read().
  [[nodiscard]] std::string_view head() const { return head_; }
  /// Moves to the last `bytes`, decompressed. False, with the position unchanged, when already past it or
  /// when the file cannot be moved in.
  /// @param unread bytes that read() gave and that do not count as read
  bool skip_to_last(std::uint64_t bytes, std::uint64_t unread);

  /// Bytes of the file as it lies on the disk that have been read.
  [[nodiscard]] std::uint64_t bytes_read() const;
  /// Why the decompression ended early; empty: it did not.
  [[nodiscard]] const std::string& damage() const { return damage_; }

 private:
  std::size_t read_on(char* to, std::size_t size);
  [[nodiscard]] std::uint64_t decompressed_size();

  std::string name_;
  gzFile_s* file_ = nullptr;
  std::string head_;
  std::size_t head_given_ = 0;
  std::uint64_t position_ = 0;  // decompressed bytes read
  std::string damage_;
};

}  // namespace isobar::text

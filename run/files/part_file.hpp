// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "run/files/text_file.hpp"

namespace isobar::files {

/// File that appears, or is replaced, as a whole by close(); until then it is FILE.part. A device or a pipe, which
/// cannot be replaced, is written at once.
/// @throws ServiceError naming the file when any operation fails
class PartFile {
 public:
  explicit PartFile(const std::filesystem::path& file);

  void write(const void* data, std::size_t bytes) { file_.write(data, bytes); }
  void write(std::string_view text) { file_.write(text); }
  void seek(long offset) { file_.seek(offset); }
  [[nodiscard]] bool is_open() const { return file_.is_open(); }
  void close();
  /// Ends without the file: what was written is removed, where it is not a device.
  void abandon();

 private:
  std::filesystem::path path_;
  std::filesystem::path written_;  ///< path_, or beside it until close()
  OutputFile file_;
};

}  // namespace isobar::files

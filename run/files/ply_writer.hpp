// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "run/files/text_file.hpp"

namespace isobar::files {

/// Streams points into a PLY file: binary, little endian, vertices of four floats x, y, z, intensity. The file
/// appears, or is replaced, as a whole by close(); until then it is FILE.part. Not thread-safe.
/// @throws ServiceError naming the file when writing fails
class PlyWriter {
 public:
  explicit PlyWriter(const std::filesystem::path& file);
  ~PlyWriter() = default;
  PlyWriter(const PlyWriter&) = delete;
  PlyWriter& operator=(const PlyWriter&) = delete;

  /// x, y, z [m] in the map frame; intensity 0 … 255.
  void add(float x_m, float y_m, float z_m, float intensity);
  /// Writes the number of points into the header and closes the file.
  void close();
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path written_;  ///< path_, or beside it until close()
  OutputFile file_;
  std::uint64_t count_ = 0;
};

}  // namespace isobar::files

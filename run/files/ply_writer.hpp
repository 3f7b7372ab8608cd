// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/map/map_point.hpp"
#include "run/files/part_file.hpp"

namespace isobar::files {

/// Properties of a vertex, all floats.
enum class PlyFields : std::uint8_t {
  kIntensity,        ///< x, y, z, intensity
  kNormalIntensity,  ///< x, y, z, nx, ny, nz, intensity
};

/// Streams points into a PLY file: binary, little endian, vertices of floats. The file appears, or is replaced, as a
/// whole by close(); until then it is FILE.part. Not thread-safe.
/// @throws ServiceError naming the file when writing fails
class PlyWriter {
 public:
  explicit PlyWriter(const std::filesystem::path& file, PlyFields fields = PlyFields::kIntensity);
  ~PlyWriter() = default;
  PlyWriter(const PlyWriter&) = delete;
  PlyWriter& operator=(const PlyWriter&) = delete;

  /// x, y, z [m] in the map frame; intensity 0 … 255. With kNormalIntensity the normal is zero.
  void add(float x_m, float y_m, float z_m, float intensity);
  void add(const MapPoint& point);
  /// Writes the number of points into the header and closes the file.
  void close();
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  PlyFields fields_;
  PartFile file_;
  std::uint64_t count_ = 0;
};

}  // namespace isobar::files

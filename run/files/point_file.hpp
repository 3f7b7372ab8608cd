// SPDX-License-Identifier: BSD-3-Clause
// Files of points in the formats of other programs.
#pragma once

#include <filesystem>
#include <memory>

#include "core/map/map_point.hpp"

namespace isobar::files {

/// A file that takes points in a stream. Not thread-safe.
/// @throws ServiceError naming the file when writing fails
class PointFile {
 public:
  PointFile() = default;
  virtual ~PointFile() = default;
  PointFile(const PointFile&) = delete;
  PointFile& operator=(const PointFile&) = delete;

  virtual void add(const MapPoint& point) = 0;
  /// Completes the file, which appears, or is replaced, as a whole; until then it is FILE.part.
  virtual void close() = 0;
};

/// Endings that open_point_file() knows, for messages.
inline constexpr const char* kPointFileEndings = ".ply, .pcd, .las";

/// Creates a file in the format of its ending: .ply (x y z nx ny nz intensity), .pcd (PcdWriter), .las (LasWriter).
/// @throws UsageError naming the endings when it has another one
[[nodiscard]] std::unique_ptr<PointFile> open_point_file(const std::filesystem::path& file);

}  // namespace isobar::files

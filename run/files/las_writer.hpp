// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

#include "core/map/map_point.hpp"
#include "run/files/part_file.hpp"

namespace isobar::files {

/// Streams points into a LAS file: version 1.2, point data record format 0 (ASPRS, "LAS Specification Version 1.2",
/// 2008), coordinates in whole millimetres, without normals, which the format has no place for. The date of creation
/// is zero, so that equal maps give equal files. Not thread-safe.
/// @throws ServiceError naming the file when writing fails
class LasWriter {
 public:
  explicit LasWriter(const std::filesystem::path& file);
  /// @throws DataError beyond 2147 km or 2^32 - 1 points, which the format cannot hold
  void add(const MapPoint& point);
  /// Writes number and extent of the points into the header; the file appears under its name.
  void close();

 private:
  [[nodiscard]] std::string header() const;

  std::string name_;
  PartFile file_;
  std::uint64_t count_ = 0;
  Eigen::Vector3d lowest_mm_ = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d highest_mm_ = -lowest_mm_;
};

}  // namespace isobar::files

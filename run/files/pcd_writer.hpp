// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/map/map_point.hpp"
#include "run/files/part_file.hpp"

namespace isobar::files {

/// Streams points into a PCD file of version 0.7 (pointclouds.org, "The PCD file format"): binary, little endian, floats
/// x y z intensity normal_x normal_y normal_z, which is pcl::PointXYZINormal. Not thread-safe.
/// @throws ServiceError naming the file when writing fails
class PcdWriter {
 public:
  explicit PcdWriter(const std::filesystem::path& file);
  void add(const MapPoint& point);
  /// Writes the number of points into the header; the file appears under its name.
  void close();

 private:
  PartFile file_;
  std::uint64_t count_ = 0;
};

}  // namespace isobar::files

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace isobar::files {

struct PlyPoints {
  std::vector<std::array<float, 3>> points;  ///< x, y, z, all finite
  std::uint64_t total = 0;                   ///< vertices in the file, before thinning
};

/// Reads x, y, z of a binary little-endian PLY file whose vertices hold them as float or double, among any
/// other scalar properties. Keeps every n-th vertex so that at most `max_points` are returned, and of those
/// the finite ones.
/// @param max_points 0 returns every vertex
/// @throws DataError "file:line: rule" or "file: rule" when the file breaks the format
PlyPoints read_ply_points(const std::filesystem::path& file, std::size_t max_points);

}  // namespace isobar::files

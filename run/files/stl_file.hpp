// SPDX-License-Identifier: BSD-3-Clause
// Surfaces as triangles in binary STL files, which viewers of meshes open.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

namespace isobar::files {

/// File of a simulated recording: every surface that does not move, in the frame of reference.tum.
inline constexpr const char* kSurfacesFile = "surfaces.stl";

/// Corners of a triangle [m].
using SurfaceTriangle = std::array<Eigen::Vector3f, 3>;

/// Creates or replaces a file.
/// @throws ServiceError naming the file when it cannot be written
void write_stl(const std::filesystem::path& file, const std::vector<SurfaceTriangle>& triangles);

/// @throws DataError "file: rule" when it cannot be read, is no binary STL, is cut, or a corner is not finite
std::vector<SurfaceTriangle> read_stl(const std::filesystem::path& file);

}  // namespace isobar::files

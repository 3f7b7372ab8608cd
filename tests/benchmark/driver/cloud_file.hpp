// SPDX-License-Identifier: BSD-3-Clause
// Readers of point clouds: PCD (binary, x y z and more) and raw floats (x y z intensity).
#pragma once

#include <filesystem>
#include <vector>

#include "core/samples.hpp"

namespace isobar::bench {

/// Reads the finite points of a *.pcd or *.bin file into `scan`, all with time 0; every n-th if there are
/// more than it holds. PCD: version 0.7, DATA binary, x, y and z as four-byte floats.
/// @throws DataError naming file and rule when the file breaks its format
void read_cloud(const std::filesystem::path& file, Scan& scan);

/// All *.pcd and *.bin files of a folder in natural order: 9.pcd comes before 10.pcd.
std::vector<std::filesystem::path> cloud_files(const std::filesystem::path& folder);

}  // namespace isobar::bench

// SPDX-License-Identifier: BSD-3-Clause
// Point clouds as others keep them: PCD (binary, x y z and more) and bare floats (x y z intensity).
#pragma once

#include <filesystem>
#include <vector>

#include "core/samples.hpp"

namespace isobar::bench {

/// The finite points of a *.pcd or *.bin file, all with time 0, every n-th if there are more than `scan`
/// holds. PCD: version 0.7, DATA binary, x, y and z as four-byte floats. Throws DataError naming the file and
/// the rule.
void read_cloud(const std::filesystem::path& file, Scan& scan);

/// All *.pcd and *.bin files of a folder by name, where runs of digits compare as numbers: 9.pcd is
/// before 10.pcd.
std::vector<std::filesystem::path> cloud_files(const std::filesystem::path& folder);

}  // namespace isobar::bench

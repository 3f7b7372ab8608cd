// SPDX-License-Identifier: BSD-3-Clause
// Files of one scan each: PCD (0.7: ascii, binary, binary_compressed), PLY (1.0: ascii, binary of either byte order) and
// the .bin of KITTI.
#pragma once

#include <filesystem>
#include <string>

#include "run/recording/cloud_file.hpp"

namespace isobar::imports {

/// Most points of a file.
inline constexpr std::uint64_t kMostFilePoints = 20'000'000;

/// Whether the name ends as one of these files does: .pcd, .ply, .bin.
[[nodiscard]] bool is_point_file(const std::filesystem::path& file);

/// Reads a file by the ending of its name. The cloud has all fields of the file, its stamp is 0.
/// @param damage set to "FILE: ends after point …" where the file was cut; may be null
/// @throws DataError "FILE: rule" when it cannot be read, or has no points with x, y and z
[[nodiscard]] recording::CloudRecord read_point_file(const std::filesystem::path& file,
                                                     std::string* damage = nullptr);

}  // namespace isobar::imports

// SPDX-License-Identifier: BSD-3-Clause
// Occupancy grid as pgm and yaml, as map_server and nav2_map_server read it.
#pragma once

#include <filesystem>
#include <string>

#include "core/floors/occupancy_grid.hpp"

namespace isobar::files {

/// Creates or replaces DIR/NAME.pgm and DIR/NAME.yaml, mode trinary: occupied black, free nearly white, unknown grey.
/// @param title a line of text for the comment of both files
/// @throws ServiceError naming the file that cannot be written
void write_grid(const std::filesystem::path& directory, const std::string& name, const std::string& title,
                const OccupancyGrid& grid);

}  // namespace isobar::files

// SPDX-License-Identifier: BSD-3-Clause
#include "run/floors/grid_file.hpp"

#include <array>
#include <cstdio>

#include "run/files/text_file.hpp"

namespace isobar::files {

namespace {

// Levels that map_saver writes. Unknown, 205, is an occupancy of 0.196: free_thresh must lie below it, or unknown cells
// are read as free.
constexpr unsigned char kBlack = 0;
constexpr unsigned char kGrey = 205;
constexpr unsigned char kWhite = 254;

char level_of(std::int8_t cell) {
  if (cell == kCellUnknown) return static_cast<char>(kGrey);
  return static_cast<char>(cell == kCellOccupied ? kBlack : kWhite);
}

/// A comment ends with its line.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return text;
}

}  // namespace

void write_grid(const std::filesystem::path& directory, const std::string& name, const std::string& title,
                const OccupancyGrid& grid) {
  const std::string comment = "# " + one_line(title) + "\n";
  std::string image =
      "P5\n" + comment + std::to_string(grid.width) + " " + std::to_string(grid.height) + "\n255\n";
  image.reserve(image.size() + grid.cells.size());
  for (int y = grid.height - 1; y >= 0; --y) {  // the first row of an image is the uppermost one
    for (int x = 0; x < grid.width; ++x) image += level_of(grid.cells[grid.index(x, y)]);
  }
  replace_file(directory / (name + ".pgm"), image);
  std::array<char, 160> numbers{};
  std::snprintf(numbers.data(), numbers.size(), "resolution: %.6g\norigin: [%.6f, %.6f, 0.0]\n",
                grid.resolution_m, grid.origin_m.x(), grid.origin_m.y());
  replace_file(directory / (name + ".yaml"), comment + "image: " + name + ".pgm\nmode: trinary\n" +
                                                 numbers.data() +
                                                 "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.1\n");
}

}  // namespace isobar::files

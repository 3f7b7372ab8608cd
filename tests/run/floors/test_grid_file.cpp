// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "run/floors/grid_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_grid_file {

namespace {

// Value that map_server gives a pixel in the mode trinary (its documentation, "Value Interpretation").
int read_as(char pixel, double occupied_thresh, double free_thresh) {
  const double occupancy = (255.0 - static_cast<unsigned char>(pixel)) / 255.0;
  if (occupancy > occupied_thresh) return 100;
  return occupancy < free_thresh ? 0 : -1;
}

}  // namespace

TEST_CASE("map_server reads back every value, the lowest row last, with the grid's origin") {
  const TemporaryFolder folder;
  OccupancyGrid grid;
  grid.origin_m = {-1.25, 3.5};
  grid.width = 3;
  grid.height = 2;
  grid.cells = {kCellFree, kCellOccupied, kCellUnknown, kCellUnknown, kCellUnknown, kCellOccupied};
  files::write_grid(folder.path(), "floor_0", "a\ntitle", grid);
  const std::string image = files::read_text_file(folder.path() / "floor_0.pgm");
  const std::string head = "P5\n# a title\n3 2\n255\n";
  REQUIRE(image.size() == head.size() + 6);
  CHECK(image.substr(0, head.size()) == head);
  const std::string yaml = files::read_text_file(folder.path() / "floor_0.yaml");
  for (const char* line : {"image: floor_0.pgm\n", "mode: trinary\n", "resolution: 0.05\n",
                           "origin: [-1.250000, 3.500000, 0.0]\n", "negate: 0\n", "occupied_thresh: 0.65\n",
                           "free_thresh: 0.1\n"}) {
    CHECK(yaml.find(line) != std::string::npos);
  }
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const char pixel = image[head.size() + static_cast<std::size_t>((1 - y) * 3 + x)];
      CHECK(read_as(pixel, 0.65, 0.1) == grid.cells[grid.index(x, y)]);
    }
  }
}

TEST_CASE("a folder that does not exist is an error that names the file") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(files::write_grid(folder.path() / "none", "floor_0", "", {}),
                       doctest::Contains("floor_0.pgm"), ServiceError);
}

}  // namespace isobar::test::test_grid_file

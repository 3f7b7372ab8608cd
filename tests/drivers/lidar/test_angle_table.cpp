// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <fstream>

#include "core/errors.hpp"
#include "drivers/lidar/angle_table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_angle_table {
namespace {

struct File {
  explicit File(const std::string& text) : path((folder.path() / "angles.csv").string()) {
    std::ofstream(path) << text;
  }
  TemporaryFolder folder;
  std::string path;
};

void fails(const std::string& text, const std::string& words) {
  CAPTURE(text);
  const File file(text);
  try {
    (void)read_angle_file(file.path, 2);
    FAIL("accepted");
  } catch (const ConfigError& error) {
    CAPTURE(error.what());
    CHECK(std::string(error.what()).find(words) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("Correction files of both makers are read") {
  for (const char* text : {"Channel,Elevation,Azimuth\n1,15.02,-0.5\n2,-3.25,1.25\n",
                           "15.02,-0.5\r\n-3.25,1.25\r\n", "# angles\n\n1, 15.02, -0.5\n2, -3.25, 1.25"}) {
    CAPTURE(text);
    const AngleTable table = read_angle_file(File(text).path, 2);
    CHECK(table.elevation_deg == std::vector<double>{15.02, -3.25});
    CHECK(table.azimuth_deg == std::vector<double>{-0.5, 1.25});
    CHECK(table.rings() == std::vector<std::uint8_t>{1, 0});
  }
}

TEST_CASE("A correction file that cannot be one is refused with its line and the rule") {
  fails("1,15,0\n3,13,0\n", "angles.csv:2: channel must be 2, in order");
  fails("1,15,0\n2,x,0\n", "angles.csv:2: must be `channel,elevation,azimuth`");
  fails("1,15,0\n2,13,0,4\n", "angles.csv:2: must be");
  fails("1,15,0\n2,15,0\n", "channel 2: has the elevation of channel 1");
  fails("1,15,0\n2,95,0\n", "channel 2: elevation must lie within -90 … 90 deg");
  fails("1,15,0\n2,nan,0\n", "channel 2: elevation");
  fails("1,15,0\n2,13,200\n", "channel 2: azimuth must lie within -30 … 30 deg");
  fails("1,15,0\n", "must hold 2 channels (holds 1)");
  fails("", "must hold 2 channels (holds 0)");
  CHECK_THROWS_AS((void)read_angle_file("/nowhere/angles.csv", 2), ConfigError);
}

}  // namespace isobar::test::test_angle_table

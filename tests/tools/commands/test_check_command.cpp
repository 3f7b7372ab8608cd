// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "simulation/simulate.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/support/exit_code.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_check_command {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

int check_command(const std::filesystem::path& recording) {
  return isobar::test::exit_code(tools::add_check_command, {"check", recording.string()});
}

/// Replaces the first occurrence of a text in a file.
void replace_in(const std::filesystem::path& file, const std::string& before, const std::string& after) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  std::string content = text.str();
  const std::size_t place = content.find(before);
  REQUIRE(place != std::string::npos);
  std::ofstream(file) << content.replace(place, before.size(), after);
}

}  // namespace

TEST_CASE(
    "check ends with 0 where nothing contradicts, with 1 where something does, and with 65 without a "
    "recording") {
  const Scratch scratch;
  const std::filesystem::path recording = scratch.path() / "drive";
  simulation::simulate({.name = "stairs-demo", .seed = 3, .stop_after_s = 4.0}, recording,
                       [](double /*fraction*/) {});
  CHECK(check_command(recording) == 0);
  // The manifest says that the IMU hangs head down; gravity says that it does not.
  replace_in(recording / "recording.toml", "xyz_m   = [0, 0, 0.2]\nrpy_deg = [0, 0, 0]",
             "xyz_m   = [0, 0, 0.2]\nrpy_deg = [180, 0, 0]");
  CHECK(check_command(recording) == 1);
  CHECK(check_command(scratch.path() / "none") == 65);
}

}  // namespace isobar::test::test_check_command

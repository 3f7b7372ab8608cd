// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <sstream>

#include "run/recording/recording_writer.hpp"
#include "tests/drivers/robosense/packet_builder.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/support/exit_code.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_points_command {
namespace {

int points_command(std::vector<std::string> words) {
  words.insert(words.begin(), "points");
  return exit_code(tools::add_points_command, words);
}

/// A capture of a Helios-16P whose device information comes last.
std::string capture(const std::filesystem::path& folder) {
  recording::RecordingWriter writer(folder / "recording", recording::Manifest::with_all_sensors());
  constexpr std::int64_t kStart = 1'732'848'127'250'000'000;
  for (int n = 0; n < 100; ++n) {
    RobosensePlan plan;
    plan.time_us += n * 1'333;
    plan.first_azimuth_deg = 4.8 * n;
    writer.add_packet(kStart + n * std::int64_t{1'333'000}, build_packet(plan), 6'699);
  }
  std::vector<int> elevations;
  for (int i = 0; i < 16; ++i) elevations.push_back(1'500 - 200 * i);
  writer.add_packet(kStart + 140'000'000, build_helios_difop(elevations, {}, 4), 7'788);
  writer.close();
  return (folder / "recording" / "lidar.pcap").string();
}

}  // namespace

TEST_CASE(
    "points of a capture are written with scan, time, ring; device information counts from the beginning") {
  const Scratch scratch;
  const std::string file = capture(scratch.path());
  const std::string csv = (scratch.path() / "p.csv").string();
  CHECK(points_command({file, "--model", "Helios-16P", "--out", csv}) == 0);
  std::istringstream lines(content_of(csv));
  std::string line;
  REQUIRE(std::getline(lines, line));
  CHECK(line == "scan,t_ns,x_m,y_m,z_m,ring,intensity");
  REQUIRE(std::getline(lines, line));
  // Laser 1 at 15.00 deg by the device information (the nominal azimuth is -4 deg, here 0): 5 m.
  CHECK(line == "0,1732848127250000000,4.864609,-0.000000,1.294095,15,0");
  int count = 1;
  while (std::getline(lines, line)) ++count;
  CHECK(count == 100 * 12 * 32);
  const std::string ply = (scratch.path() / "p.ply").string();
  CHECK(points_command({file, "--model", "Helios-16P", "--out", ply}) == 0);
  CHECK(content_of(ply).starts_with("ply\n"));
}

TEST_CASE(
    "a capture without packets of the model, an unknown model or ending are errors with their own codes") {
  const Scratch scratch;
  const std::string file = capture(scratch.path());
  CHECK(points_command({file, "--model", "VLP-16"}) == 65);
  CHECK(points_command({file, "--model", "Helios-16P", "--port", "1000"}) == 65);
  CHECK(points_command({file, "--model", "VLS-128"}) == 64);
  CHECK(points_command({file, "--model", "Helios-16P", "--out", "p.xyz"}) == 64);
  CHECK(points_command({(scratch.path() / "none.pcap").string()}) == 65);
}

}  // namespace isobar::test::test_points_command

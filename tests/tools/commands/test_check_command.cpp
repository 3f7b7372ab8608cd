// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "daemon/recording_check.hpp"
#include "daemon/silent_lidar.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/recording_writer.hpp"
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

/// Writes an event with another stamp.
void write_moved(recording::Event& event, std::int64_t by_ns, recording::RecordingWriter& writer) {
  event.imu.stamp_ns += by_ns;
  event.pressure.stamp_ns += by_ns;
  event.wheel.stamp_ns += by_ns;
  switch (event.kind) {
    case recording::EventKind::kLidarPacket:
      writer.add_packet(event.stamp_ns + by_ns, event.packet);
      break;
    case recording::EventKind::kImu:
      writer.add_imu(event.imu);
      break;
    case recording::EventKind::kPressure:
      writer.add_pressure(event.pressure);
      break;
    case recording::EventKind::kBasePressure:
      writer.add_base_pressure(event.pressure);
      break;
    case recording::EventKind::kWheel:
      writer.add_wheel(event.wheel);
      break;
    case recording::EventKind::kCloud:
      writer.add_cloud(*event.cloud);
      break;
  }
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

TEST_CASE("a recording whose lidar sent nothing to its port is an error of check, with what was found") {
  const Scratch scratch;
  const std::filesystem::path recording = scratch.path() / "drive";
  simulation::simulate({.name = "stairs-demo", .seed = 3, .stop_after_s = 1.0}, recording,
                       [](double /*fraction*/) {});
  replace_in(recording / "recording.toml", "port    = 2368", "port    = 2370");
  CHECK(check_command(recording) == 65);
}

TEST_CASE("the lidar's own clock tells that a recording's clock was set forward, not paused") {
  const Scratch scratch;
  simulation::simulate({.name = "stairs-demo", .seed = 3, .stop_after_s = 4.0}, scratch.path() / "drive",
                       [](double /*fraction*/) {});
  constexpr std::int64_t kStepNs = 20'000'000'000;
  {
    recording::RecordingReader reader(scratch.path() / "drive");
    recording::RecordingWriter writer(scratch.path() / "set", reader.manifest());
    std::int64_t first_ns = 0;
    for (recording::Event event; reader.next(event);) {
      first_ns = first_ns == 0 ? event.stamp_ns : first_ns;
      const std::int64_t step_ns = event.stamp_ns - first_ns > 2'000'000'000 ? kStepNs : 0;
      write_moved(event, step_ns, writer);
    }
    writer.close();
  }
  recording::RecordingReader reader(scratch.path() / "set");
  const Config used = with_sensors_of(reader.manifest(), Config{});
  const RecordingCheck check = check_recording(scratch.path() / "set", used, [](double /*fraction*/) {});
  const bool said = std::any_of(check.notes.begin(), check.notes.end(), [](const std::string& note) {
    return note.find("the clock was set forward by 20.0") != std::string::npos;
  });
  CHECK(said);
  CHECK(check.times[static_cast<std::size_t>(CheckedSensor::kImu)].length_s() ==
        doctest::Approx(4.0).epsilon(0.02));
  CHECK(check.times[static_cast<std::size_t>(CheckedSensor::kLidar)].longest_gap_s() < 0.15);
}

TEST_CASE("packets of a lidar without data packets ask for its laser, unless another port is as busy") {
  const LidarModel& model = *find_lidar_model("VLP-16");
  recording::PortsSeen ports;
  CHECK(only_information_text(model, 8308, ports, 0).empty());
  for (int i = 0; i < 100; ++i) ports.add(8308);
  ports.add(5353);
  CHECK(only_information_text(model, 8308, ports, 0) ==
        "position packets only (100), no data packet: is the laser off?");
  for (int i = 0; i < 100; ++i) ports.add(2370);
  CHECK(only_information_text(model, 8308, ports, 0).empty());
  CHECK_FALSE(only_information_text(*find_lidar_model("XT16"), 0, recording::PortsSeen{}, 3).empty());
}

}  // namespace isobar::test::test_check_command

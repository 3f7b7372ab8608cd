// SPDX-License-Identifier: BSD-3-Clause
// Faults in a recording: each is counted and reported, and the valid data around it is used.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/reference.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_bad_input {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

bool warns_of(const ReplaySummary& summary, const std::string& words) {
  return std::any_of(summary.warnings.begin(), summary.warnings.end(),
                     [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

recording::Manifest manifest_of(const std::filesystem::path& folder) {
  std::vector<std::string> warnings;
  return recording::read_manifest(folder, warnings);
}

/// Stamp of the first event of a recording.
std::int64_t start_of(const std::filesystem::path& folder) {
  recording::RecordingReader reader(folder);
  recording::Event event;
  REQUIRE(reader.next(event));
  return event.stamp_ns;
}

}  // namespace

TEST_CASE("without a base station the run warns and uses the robot's barometer alone") {
  const auto folder =
      copy_with(short_drive(), "no-base", [](auto& manifest) { manifest.base_barometer.reset(); }, {});
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(warns_of(summary, "no base station"));
  CHECK(bytes_of(out / "status.csv").find(",single_barometer,") != std::string::npos);
  CHECK(largest_error_m(short_drive(), out) < 0.3);
}

TEST_CASE("without wheels the run warns and uses constant velocity between scans") {
  const auto folder =
      copy_with(short_drive(), "no-wheel", [](auto& manifest) { manifest.wheel.reset(); }, {});
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(warns_of(summary, "no wheels"));
  CHECK(largest_error_m(short_drive(), out) < 0.3);
}

TEST_CASE("without an IMU the lidar runs alone, as 6-DOF, and the run says what that costs") {
  for (const bool with_others : {true, false}) {
    const auto folder = copy_with(short_drive(), with_others ? "no-imu" : "lidar-only",
                                  [with_others](auto& manifest) {
                                    manifest.imu.reset();
                                    if (with_others) return;
                                    manifest.wheel.reset();
                                    manifest.barometer.reset();
                                    manifest.base_barometer.reset();
                                  },
                                  {});
    std::filesystem::path out;
    const auto summary = run(folder, out);
    CHECK(warns_of(summary, "no IMU: every scan as 6-DOF"));
    CHECK(summary.registered + 15 > summary.scans);  // a second of bootstrap
    const std::string status = bytes_of(out / "status.csv");
    CHECK(status.find(",registered,6dof,") != std::string::npos);
    CHECK(largest_error_m(short_drive(), out) < 0.5);
  }
}

TEST_CASE("without a barometer 3-DOF runs as 4-DOF and the run warns") {
  const auto folder = copy_with(short_drive(), "no-baro",
                                [](auto& manifest) {
                                  manifest.barometer.reset();
                                  manifest.base_barometer.reset();
                                },
                                {});
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(warns_of(summary, "3-DOF runs as 4-DOF"));
  const std::string status = bytes_of(out / "status.csv");
  CHECK(status.find(",4dof,none,") != std::string::npos);
  CHECK(status.find(",3dof,") == std::string::npos);
  CHECK(largest_error_m(short_drive(), out) < 0.3);
}

TEST_CASE("five seconds without lidar are bridged by the prior, then scans register again") {
  const auto manifest = manifest_of(short_drive());
  const std::int64_t start_ns = start_of(short_drive());
  const auto folder = copy_with(short_drive(), "gap", {}, [&](const auto& event, auto& writer) {
    const double t_s = static_cast<double>(event.stamp_ns - start_ns) * 1e-9;
    if (event.kind == recording::EventKind::kLidarPacket && t_s > 6.0 && t_s < 11.0) return;
    write_event(event, manifest, writer);
  });
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(summary.poses >= 130);
  const auto poses = recording::read_tum(out / "trajectory.tum");
  std::int64_t largest_gap_ns = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    largest_gap_ns = std::max(largest_gap_ns, poses[i].stamp_ns - poses[i - 1].stamp_ns);
  }
  CHECK(largest_gap_ns < 400'000'000);
  // Dead reckoning over 3 m of travel: 10 % of it at most.
  CHECK(largest_error_m(short_drive(), out) < 0.3);
}

TEST_CASE("broken packets among valid ones are counted by kind and change nothing") {
  const auto manifest = manifest_of(short_drive());
  int index = 0;
  const auto folder = copy_with(short_drive(), "broken", {}, [&](const auto& event, auto& writer) {
    write_event(event, manifest, writer);
    if (event.kind != recording::EventKind::kLidarPacket || ++index % 50 != 0) return;
    std::vector<std::uint8_t> packet(event.packet.begin(), event.packet.end());
    writer.add_packet(event.stamp_ns, packet);  // twice
    writer.add_packet(event.stamp_ns, std::span(packet).first(700));
    packet.resize(1300, 0x55);
    writer.add_packet(event.stamp_ns, packet);  // too long
    std::fill(packet.begin(), packet.end(), 0xA5);
    writer.add_packet(event.stamp_ns, std::span(packet).first(1206));  // noise
  });
  std::filesystem::path clean_out;
  std::filesystem::path out;
  run(short_drive(), clean_out);
  const auto summary = run(folder, out);
  CHECK(count_of(summary, "lidar packets duplicated") > 100);
  CHECK(count_of(summary, "lidar packets truncated") > 100);
  CHECK(count_of(summary, "lidar packets oversized") > 100);
  CHECK(count_of(summary, "lidar packets garbage") > 100);
  CHECK(bytes_of(out / "trajectory.tum") == bytes_of(clean_out / "trajectory.tum"));
}

TEST_CASE("packets of another model are refused with an error that names both models") {
  const auto folder =
      copy_with(short_drive(), "model", [](auto& manifest) { manifest.lidar->model = "HDL-32E"; }, {});
  std::filesystem::path out;
  try {
    run(folder, out);
    FAIL("no error");
  } catch (const DataError& error) {
    const std::string what = error.what();
    CHECK(what.find("HDL-32E") != std::string::npos);
    CHECK(what.find("VLP-16") != std::string::npos);
  }
}

TEST_CASE("invalid rows of CSV files are counted with file and line and change nothing") {
  const auto folder = copy_with(short_drive(), "rows", {}, {});
  const std::string imu = bytes_of(folder / "imu.csv");
  const std::size_t middle = imu.find('\n', imu.size() / 2) + 1;
  const std::string row = imu.substr(middle, imu.find('\n', middle) - middle);
  const std::string stamp = row.substr(0, row.find(','));
  std::string broken = imu.substr(0, middle);
  broken += stamp + ",nan,0,0,0,0,9.81\n" + stamp + ",inf,0,0,0,0,9.81\n" + stamp + ",1e9,0,0,0,0,9.81\n";
  broken += "words,0,0\n\n" + stamp + ",0\n";
  broken += "9" + stamp.substr(1) + ",0,0,0,0,0,9.81\n";  // decades ahead
  broken += "1000,0,0,0,0,0,9.81\n";                      // 1970
  broken += imu.substr(middle);
  std::ofstream(folder / "imu.csv", std::ios::binary) << broken;
  std::filesystem::path clean_out;
  std::filesystem::path out;
  run(short_drive(), clean_out);
  const auto summary = run(folder, out);
  std::uint64_t refused = 0;
  bool names_place = false;
  for (const files::RunCount& count : summary.counts) {
    if (count.name.rfind("imu: ", 0) != 0 || count.first_message.empty()) continue;
    refused += count.count;
    names_place = names_place || count.first_message.find("imu.csv:") != std::string::npos;
  }
  CHECK(refused >= 6);
  CHECK(names_place);
  CHECK(bytes_of(out / "trajectory.tum") == bytes_of(clean_out / "trajectory.tum"));
}

TEST_CASE("pressure spikes of thousands of pascals and NaN do not move the height") {
  const auto manifest = manifest_of(short_drive());
  int index = 0;
  const auto folder = copy_with(short_drive(), "spikes", {}, [&](recording::Event event, auto& writer) {
    if (event.kind == recording::EventKind::kPressure && ++index % 40 == 0)
      event.pressure.pressure_pa -= 3000.0;
    write_event(event, manifest, writer);
  });
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(count_of(summary, "barometer samples with bad values") >= 5);
  CHECK(largest_error_m(short_drive(), out) < 0.15);
}

TEST_CASE("three seconds without IMU are bridged by the scans") {
  const auto manifest = manifest_of(short_drive());
  const std::int64_t start_ns = start_of(short_drive());
  const auto folder = copy_with(short_drive(), "imu-gap", {}, [&](const auto& event, auto& writer) {
    const double t_s = static_cast<double>(event.stamp_ns - start_ns) * 1e-9;
    if (event.kind == recording::EventKind::kImu && t_s > 7.0 && t_s < 10.0) return;
    write_event(event, manifest, writer);
  });
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(count_of(summary, "imu gaps") == 1);
  CHECK(bytes_of(out / "status.csv").find(",registered,6dof,") != std::string::npos);
  // The limit of the clean drive; poses that ended with the IMU would be off by more than a metre.
  CHECK(largest_error_m(short_drive(), out) < 0.15);
}

TEST_CASE("a barometer off by kilopascals for seconds does not move the height") {
  const auto manifest = manifest_of(short_drive());
  const std::int64_t start_ns = start_of(short_drive());
  for (const auto kind : {recording::EventKind::kPressure, recording::EventKind::kBasePressure}) {
    const auto folder = copy_with(short_drive(), "level", {}, [&](recording::Event event, auto& writer) {
      const double t_s = static_cast<double>(event.stamp_ns - start_ns) * 1e-9;
      if (event.kind == kind && t_s > 5.0 && t_s < 10.0) event.pressure.pressure_pa += 5000.0;
      write_event(event, manifest, writer);
    });
    std::filesystem::path out;
    run(folder, out);
    CHECK(largest_error_m(short_drive(), out) < 0.25);  // the level is estimated from 16 samples, 0.1 m
  }
}

TEST_CASE("a pressure step that is faster than any climb does not move the height") {
  const auto manifest = manifest_of(short_drive());
  const std::int64_t start_ns = start_of(short_drive());
  const auto folder = copy_with(short_drive(), "step", {}, [&](recording::Event event, auto& writer) {
    const double t_s = static_cast<double>(event.stamp_ns - start_ns) * 1e-9;
    if (event.kind == recording::EventKind::kPressure && t_s > 6.0) event.pressure.pressure_pa += 50.0;
    write_event(event, manifest, writer);
  });
  std::filesystem::path out;
  const auto summary = run(folder, out);
  CHECK(count_of(summary, "barometer steps believed") == 1);
  CHECK(largest_error_m(short_drive(), out) < 0.15);  // 50 Pa are 4.2 m
}

}  // namespace isobar::test::test_bad_input

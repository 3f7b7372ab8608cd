// SPDX-License-Identifier: BSD-3-Clause
// Every combination of missing sensors: IMU, wheels, barometer, base station.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "daemon/missing_sensors.hpp"
#include "daemon/stage_settings.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_missing_sensors {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

constexpr std::int64_t kLengthNs = 8'000'000'000;

/// The first 8 s of the drive, of a robot with these sensors.
std::filesystem::path drive_with(const PresentSensors& present) {
  recording::RecordingReader reader(short_drive());
  recording::Event first;
  REQUIRE(reader.next(first));
  recording::Manifest kept = reader.manifest();
  const auto leave_out = [&present](recording::Manifest& manifest) {
    if (!present.imu) manifest.imu.reset();
    if (!present.wheels) manifest.wheel.reset();
    if (!present.barometer) manifest.barometer.reset();
    if (!present.base_station) manifest.base_barometer.reset();
  };
  leave_out(kept);
  return copy_with(short_drive(), "missing", leave_out, [&](const auto& event, auto& writer) {
    if (event.stamp_ns < first.stamp_ns + kLengthNs) write_event(event, kept, writer);
  });
}

std::string height_source_of(const PresentSensors& present) {
  if (!present.barometer) return "none";
  return present.base_station ? "differential" : "single_barometer";
}

bool says(const ReplaySummary& summary, const std::string& words) {
  return std::any_of(summary.warnings.begin(), summary.warnings.end(),
                     [&words](const std::string& warning) { return warning.starts_with(words); });
}

void check(const PresentSensors& present) {
  CAPTURE(present.imu);
  CAPTURE(present.wheels);
  CAPTURE(present.barometer);
  CAPTURE(present.base_station);
  const auto recording = drive_with(present);
  std::filesystem::path out;
  const ReplaySummary summary = run(recording, out, Method::kAdaptive);
  // With gravity the map begins after 2.5 s of rest; then, and without it, after a second of bootstrap.
  CHECK(summary.registered + (present.imu ? 40 : 15) >= summary.scans);
  CHECK(summary.scans >= 75);
  CHECK(largest_error_m(recording, out) < 0.2);
  CHECK(says(summary, "no IMU") == !present.imu);
  CHECK(says(summary, "no wheels") == !present.wheels);
  CHECK(says(summary, "no barometer") == !present.barometer);
  CHECK(says(summary, "no base station") == (present.barometer && !present.base_station));
  const std::string status = bytes_of(out / "status.csv");
  const std::string last = status.substr(status.rfind('\n', status.size() - 2) + 1);
  CAPTURE(last);
  CHECK(last.find("," + height_source_of(present) + ",") != std::string::npos);
  CHECK(last.find(",registered,") != std::string::npos);
}

}  // namespace

TEST_CASE("a robot registers its scans with any of its sensors missing, and says what that costs") {
  for (unsigned missing = 0; missing < 16; ++missing) {
    check({.imu = (missing & 1U) == 0,
           .wheels = (missing & 2U) == 0,
           .barometer = (missing & 4U) == 0,
           .base_station = (missing & 8U) == 0});
  }
}

TEST_CASE("a configuration without an IMU leaves that of a recording unused") {
  Config config;
  config.imu.source = ImuSource::kNone;
  const std::filesystem::path out = fresh_folder("unused-imu");
  const ReplaySummary summary =
      replay(copy_with(short_drive(), "with-imu", {}, {}), config, out, [](double) {});
  CHECK(says(summary, "no IMU"));
  std::filesystem::path without;
  run(copy_with(short_drive(), "no-imu", [](auto& manifest) { manifest.imu.reset(); }, {}), without,
      Method::kAdaptive);
  CHECK(bytes_of(out / "trajectory.tum") == bytes_of(without / "trajectory.tum"));
}

TEST_CASE("the sensors of a recording are those of its manifest, wheels included") {
  recording::Manifest manifest = recording::Manifest::with_all_sensors();
  Config config;
  config.wheel.source = WheelSource::kEncoder;
  CHECK(with_sensors_of(manifest, config).wheel.source == WheelSource::kEncoder);
  CHECK(stage_settings(with_sensors_of(manifest, config)).uses_wheels);
  manifest.wheel.reset();
  CHECK(with_sensors_of(manifest, config).wheel.source == WheelSource::kNone);
  CHECK_FALSE(stage_settings(with_sensors_of(manifest, config)).uses_wheels);
}

}  // namespace isobar::test::test_missing_sensors

// SPDX-License-Identifier: BSD-3-Clause
// Sensors that contradict the configuration or each other: said, and left out of the run.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include "core/contradictions/input_check.hpp"
#include "core/errors.hpp"
#include "daemon/recording_check.hpp"
#include "daemon/stage_settings.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "simulation/simulate.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_contradictions {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

constexpr std::int64_t kHourNs = 3'600'000'000'000;

/// The drive with changed samples.
std::filesystem::path changed(const std::string& name, const std::function<void(recording::Event&)>& change) {
  recording::RecordingReader reader(short_drive());
  const recording::Manifest manifest = reader.manifest();
  return copy_with(
      short_drive(), name, [](recording::Manifest& /*manifest*/) {},
      [&](const auto& event, auto& writer) {
        recording::Event copy = event;
        change(copy);
        write_event(copy, manifest, writer);
      });
}

void turn_upside_down(recording::Event& event) {
  for (Eigen::Vector3d* vector : {&event.imu.gyro_rad_s, &event.imu.accel_m_s2}) {
    *vector = Eigen::Vector3d(vector->x(), -vector->y(), -vector->z());
  }
}

bool is_said(const ReplaySummary& summary, const std::string& words) {
  return std::any_of(summary.warnings.begin(), summary.warnings.end(), [&words](const std::string& warning) {
    return warning.find(words) != std::string::npos;
  });
}

/// Replays and expects a run without the IMU that says this.
void check_run_without_imu(const std::filesystem::path& recording, const std::string& words) {
  std::filesystem::path out;
  const ReplaySummary summary = run(recording, out, Method::kAdaptive);
  CHECK(is_said(summary, words));
  CHECK(is_said(summary, "not used: IMU"));
  CHECK(is_said(summary, "no IMU"));
  CHECK(largest_error_m(recording, out) < 0.3);
  CHECK(bytes_of(out / "counters.csv").find(words) != std::string::npos);
}

/// What the reader's events say at the end of each second, and at the end.
void check_no_finding_at_any_time(const std::filesystem::path& recording) {
  recording::RecordingReader reader(recording);
  const Config used = with_sensors_of(reader.manifest(), {});
  InputCheck check({.imu = used.imu.mount, .lidar = used.lidar.mount});
  ScanAssembler assembler(make_lidar_decoder(stage_settings(used).lidar));
  const auto scan = std::make_unique<Scan>();
  recording::Event event;
  std::int64_t judged_ns = 0;
  while (reader.next(event)) {
    if (event.kind == recording::EventKind::kImu) check.add_imu(event.imu);
    if (event.kind == recording::EventKind::kWheel) check.add_wheel(event.wheel);
    if (event.kind == recording::EventKind::kPressure) check.add_pressure(event.pressure);
    if (event.kind == recording::EventKind::kBasePressure) check.add_base_pressure(event.pressure);
    if (event.kind == recording::EventKind::kLidarPacket &&
        assembler.add_packet(event.packet, event.stamp_ns, *scan).scan_complete) {
      check.add_scan(*scan);
    }
    if (event.stamp_ns - judged_ns < 1'000'000'000) continue;
    judged_ns = event.stamp_ns;
    REQUIRE(check.find().empty());
  }
  Findings findings;
  check.add_clocks(findings);
  check.add_overlaps(findings);
  CHECK(findings.empty());
}

}  // namespace

TEST_CASE("an IMU upside down is said and left out: the map is the right way up") {
  check_run_without_imu(changed("down",
                                [](recording::Event& event) {
                                  if (event.kind == recording::EventKind::kImu) turn_upside_down(event);
                                }),
                        "imu.rpy_deg = [180, 0, 0] would fit");
}

TEST_CASE("a gyro in deg/s is said and left out") {
  check_run_without_imu(changed("degrees",
                                [](recording::Event& event) {
                                  if (event.kind == recording::EventKind::kImu)
                                    event.imu.gyro_rad_s *= 57.29578;
                                }),
                        "is it in deg/s?");
}

TEST_CASE("wheels in km/h are said and left out, and gravity stays") {
  const auto recording = changed("kmh", [](recording::Event& event) {
    if (event.kind == recording::EventKind::kWheel) event.wheel.vx_m_s *= 3.6;
  });
  std::filesystem::path out;
  const ReplaySummary summary = run(recording, out, Method::kAdaptive);
  CHECK(is_said(summary, "are they in km/h?"));
  CHECK(is_said(summary, "not used: wheels"));
  CHECK_FALSE(is_said(summary, "no IMU"));
  CHECK(largest_error_m(recording, out) < 0.3);
}

TEST_CASE("an IMU whose clock is 8 h behind is refused in a sentence, before anything is written") {
  const auto recording = changed("hours", [](recording::Event& event) {
    if (event.kind != recording::EventKind::kImu) return;
    event.stamp_ns -= 8 * kHourNs;
    event.imu.stamp_ns -= 8 * kHourNs;
  });
  std::filesystem::path out;
  try {
    run(recording, out);
    FAIL("not refused");
  } catch (const DataError& error) {
    const std::string text = error.what();
    CAPTURE(text);
    CHECK(text.find("the clock of the IMU is about 8 h 0 min") != std::string::npos);
    CHECK(text.find("is it another time zone?") != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(out / "trajectory.tum"));
}

TEST_CASE("the drive itself says nothing, and uses everything") {
  std::filesystem::path out;
  const ReplaySummary summary = run(short_drive(), out, Method::kAdaptive);
  CHECK_FALSE(is_said(summary, "not used"));
  CHECK_FALSE(is_said(summary, "would fit"));
}

TEST_CASE(
    "no simulated robot contradicts itself: ramps, stairs, elevators, gusts, a hanging sphere, a start in "
    "motion") {
  for (const simulation::ScenarioInfo& scenario : simulation::scenarios()) {
    if (scenario.is_long) continue;
    simulation::ScenarioRequest request{.name = scenario.name, .seed = 4, .stop_after_s = 25.0};
    for (const double start_at_s : {0.0, 10.0}) {
      CAPTURE(scenario.name);
      request.deviations.start_at_s = start_at_s;
      const std::filesystem::path recording = fresh_folder("no-contradiction");
      simulation::simulate(request, recording, [](double /*fraction*/) {});
      check_no_finding_at_any_time(recording);
      std::filesystem::remove_all(recording);
    }
  }
}

}  // namespace isobar::test::test_contradictions

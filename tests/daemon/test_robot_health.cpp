// SPDX-License-Identifier: BSD-3-Clause
// Health entries of a robot from the status of its threads.
#include "daemon/health.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "daemon/health_summary.hpp"
#include "daemon/status_figures.hpp"
#include "ipc/topics.hpp"

namespace isobar::test::test_robot_health {

namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 1'000 * kSecond;

void note_output(DeadlineStatus& stage, std::int64_t now_ns) {
  ++stage.outputs;
  stage.last_ns = now_ns;
  stage.limit_ns = 10'000'000;
  stage.times.note(2'000'000);
}

/// A robot all of whose sensors have just sent; wheels and base station only if `with_all`.
StatusSnapshot working(std::int64_t now_ns, bool with_all) {
  StatusSnapshot status;
  status.now_ns = now_ns;
  status.lidar.last_packet_ns = now_ns;
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    if (!with_all && kind >= static_cast<std::size_t>(datagram::Kind::kBasePressure)) continue;
    status.prior.samples[kind] = static_cast<std::uint64_t>(now_ns / 10'000'000);
    status.prior.last_sample_ns[kind] = now_ns;
  }
  if (with_all) status.prior.base_stations[0].add(now_ns);
  status.prior.stamp_ns = now_ns;
  status.prior.attitude_valid = true;
  status.prior.height_variance_m2 = 0.01;
  status.prior.height_source = with_all ? HeightSource::kDifferential : HeightSource::kSingleBarometer;
  status.prior.counters.pressure_accepted = 1;
  status.prior.barometers.robot = BarometerFault::kOk;
  status.registration.scans = 10;
  status.registration.mode = PoseMode::kRegistered;
  status.registration.pose.stamp_ns = now_ns;
  for (DeadlineStatus* stage : {&status.lidar.punctuality, &status.prior.punctuality,
                                &status.registration.punctuality, &status.map.punctuality}) {
    note_output(*stage, now_ns);
  }
  return status;
}

HealthReport report_of(HealthMonitor& monitor, const StatusSnapshot& status) {
  HealthReport report;
  reserve_summary(report);
  monitor.fill(status, report);
  fill_summary(report);
  return report;
}

const ipc::HealthEntry& entry(const HealthReport& report, const std::string& name) {
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    if (name == report.entries[i].name) return report.entries[i];
  }
  FAIL("no entry " << name);
  return report.entries[0];
}

}  // namespace

TEST_CASE("12 s after all sensors fell silent no entry is ok any more but what the robot does not have") {
  HealthMonitor monitor{Config{}};
  StatusSnapshot status = working(kStart, true);
  CHECK(std::string(report_of(monitor, status).entries[0].message) == "all is well");
  status.now_ns += 12 * kSecond;
  const HealthReport report = report_of(monitor, status);
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    CAPTURE(report.entries[i].name);
    CHECK(report.entries[i].level != HealthLevel::kOk);
  }
  for (const char* name :
       {"attitude", "height", "registration", "map", "barometer/fault", "prior/deadline"}) {
    CAPTURE(name);
    CHECK(entry(report, name).level == HealthLevel::kStale);
  }
  CHECK(entry(report, "lidar").level == HealthLevel::kError);
  CHECK(std::string(entry(report, "height").message) == "no IMU sample for 12 s");
}

TEST_CASE("what became of a hint is an entry, a refused one a warning for a minute") {
  HealthMonitor monitor{Config{}};
  StatusSnapshot status = working(kStart, true);
  const HealthReport without = report_of(monitor, status);
  for (std::uint32_t i = 0; i < without.entry_count; ++i) {
    CHECK(std::string(without.entries[i].name) != "initial_pose");
  }
  status.registration.hint = {
      .given = 2, .outcome = HintOutcome::kNoMatch, .stamp_ns = kStart, .radius_m = 1.5, .distance_m = 50.25};
  const HealthReport report = report_of(monitor, status);
  CHECK(entry(report, "initial_pose").level == HealthLevel::kWarning);
  CHECK(entry(report, "initial_pose").value == 2.0);
  CHECK(std::string(entry(report, "initial_pose").message) ==
        "refused: no hypothesis around it matches (within 1.5 m); 50.2 m from where the robot was");
  StatusSnapshot later = working(kStart + 61 * kSecond, true);
  later.registration.hint = status.registration.hint;
  CHECK(entry(report_of(monitor, later), "initial_pose").level == HealthLevel::kOk);
  status.registration.hint.outcome = HintOutcome::kFound;
  CHECK(entry(report_of(monitor, status), "initial_pose").level == HealthLevel::kOk);
}

TEST_CASE("the floor of the status is the one that was told, with a name that ends") {
  ipc::CurrentFloor floor;
  floor.known = true;
  floor.number = 3;
  floor.certainty = 0.75;
  floor.z_m = 7.0;
  std::fill(std::begin(floor.name), std::end(floor.name), 'x');
  ipc::FloorFigures figures;
  fill_floor(floor, figures);
  CHECK(figures.present);
  CHECK(figures.known);
  CHECK(figures.number == 3);
  CHECK(figures.certainty == 0.75);
  CHECK(std::string(figures.name) == std::string(sizeof(figures.name) - 1, 'x'));
}

TEST_CASE("wheels that were never heard are none, unless they are expected; once heard, silence is a fault") {
  HealthMonitor monitor{Config{}};
  CHECK(entry(report_of(monitor, working(kStart, false)), "wheels").level == HealthLevel::kOk);
  CHECK(std::string(entry(report_of(monitor, working(kStart, false)), "wheels").message).starts_with("none"));
  Config config;
  config.input.expect_wheels = true;
  HealthMonitor expecting{config};
  CHECK(entry(report_of(expecting, working(kStart, false)), "wheels").level == HealthLevel::kStale);
  StatusSnapshot heard = working(kStart, true);
  heard.now_ns += 2 * kSecond;
  CHECK(entry(report_of(monitor, heard), "wheels").level == HealthLevel::kError);
}

TEST_CASE(
    "encoders of this machine are the wheels' entry; slip and lost edges are warnings while they grow") {
  Config config;
  config.wheel.source = WheelSource::kEncoder;
  HealthMonitor monitor{config};
  StatusSnapshot status = working(kStart, true);
  status.wheels.present = true;
  std::string("encoders on /dev/gpiochip0").copy(status.wheels.place.data(), 79);
  status.wheels.device.state = DeviceState::kMeasuring;
  status.wheels.device.last_sample_ns = kStart;
  CHECK(entry(report_of(monitor, status), "wheels").level == HealthLevel::kOk);
  status.wheels.device.counters.corrupt = 3;
  status.prior.counters.wheel_turn_slips = 2;
  HealthReport report = report_of(monitor, status);
  CHECK(std::string(entry(report, "wheels").message).ends_with("from encoders on /dev/gpiochip0"));
  CHECK(entry(report, "wheels/lost_edges").level == HealthLevel::kWarning);
  CHECK(entry(report, "wheels/turn_slip").level == HealthLevel::kWarning);
  CHECK(entry(report, "wheels/turn_slip").value == 2.0);
  report = report_of(monitor, status);
  CHECK(entry(report, "wheels/lost_edges").level == HealthLevel::kOk);
  CHECK(entry(report, "wheels/turn_slip").level == HealthLevel::kOk);
  status.wheels.device.state = DeviceState::kNoAnswer;
  std::string("another program holds a line").copy(status.wheels.device.fault.data(), 95);
  report = report_of(monitor, status);
  CHECK(entry(report, "wheels").level == HealthLevel::kError);
  CHECK(std::string(entry(report, "wheels").message) ==
        "encoders on /dev/gpiochip0: another program holds a line");
}

TEST_CASE("a robot that is lost is an error of the registration, with the reason and since when") {
  HealthMonitor monitor{Config{}};
  StatusSnapshot status = working(kStart, true);
  status.registration.mode = PoseMode::kPriorOnly;
  status.registration.lost = LostReason::kTilt;
  status.registration.lost_since_ns = kStart - 3 * kSecond;
  const HealthReport report = report_of(monitor, status);
  CHECK(entry(report, "registration").level == HealthLevel::kError);
  CHECK(std::string(entry(report, "registration").message) ==
        "lost since 3.0 s: the scans are tilted against gravity; dead reckoning, not mapped");
}

TEST_CASE("a robot without a base station is well if it is configured so, and waits for one otherwise") {
  HealthMonitor waiting{Config{}};
  CHECK(report_of(waiting, working(kStart, false)).entries[0].level == HealthLevel::kStale);
  Config config;
  config.input.expect_base_station = false;
  HealthMonitor alone{config};
  const HealthReport report = report_of(alone, working(kStart, false));
  CHECK(std::string(report.entries[0].message) == "all is well");
  CHECK(entry(report, "height").level == HealthLevel::kOk);
  CHECK(std::string(entry(report, "height").message).ends_with("drifts with the weather"));
}

TEST_CASE("an IMU or a barometer that is configured away is none and not missed; one that is configured is") {
  Config config;
  config.imu.source = ImuSource::kNone;
  config.barometer.source = BarometerSource::kNone;
  StatusSnapshot status = working(kStart, true);
  status.prior.samples[0] = status.prior.samples[1] = 0;
  status.prior.last_sample_ns[0] = status.prior.last_sample_ns[1] = 0;
  status.prior.attitude_valid = false;
  status.prior.height_source = HeightSource::kNone;
  HealthMonitor without{config};
  const HealthReport report = report_of(without, status);
  CHECK(entry(report, "imu").level == HealthLevel::kOk);
  CHECK(std::string(entry(report, "imu").message) == "none: imu.source is \"none\"");
  CHECK(entry(report, "barometer").level == HealthLevel::kOk);
  CHECK(entry(report, "attitude").level == HealthLevel::kOk);
  CHECK(std::string(entry(report, "attitude").message).starts_with("no IMU"));
  CHECK(entry(report, "height").level == HealthLevel::kOk);
  status.prior.samples[0] = 5;
  CHECK(entry(report_of(without, status), "imu").level == HealthLevel::kWarning);
  status.prior.samples[0] = 0;
  HealthMonitor with{Config{}};
  CHECK(entry(report_of(with, status), "imu").level == HealthLevel::kStale);
  CHECK(entry(report_of(with, status), "barometer").level == HealthLevel::kStale);
  CHECK(entry(report_of(with, status), "attitude").level == HealthLevel::kStale);
}

TEST_CASE("a report with every fault at once fits") {
  HealthMonitor monitor{Config{}};
  const StatusSnapshot before = working(kStart, true);
  static_cast<void>(report_of(monitor, before));
  StatusSnapshot all = working(kStart + kSecond, true);
  const auto fill = [](auto& counters) {
    // Counter structures hold 64-bit counters only.
    auto* words = reinterpret_cast<std::uint64_t*>(&counters);
    std::fill(words, words + sizeof(counters) / sizeof(std::uint64_t), 7U);
  };
  fill(all.lidar.counters);
  fill(all.samples.counters);
  fill(all.prior.counters);
  fill(all.samples.base.samples);
  all.prior.barometers.base_heard = {true, true};
  all.registration.from_prior = all.registration.dropped_scans = all.registration.dropped_priors =
      all.registration.bridged = all.map.dropped_scans = all.prior.dropped_samples = 3;
  const HealthReport report = report_of(monitor, all);
  CHECK(report.entry_count > 40);
  CHECK(report.entry_count < HealthReport::kMaxEntries - 64);  // room for other parts of the program
}

TEST_CASE("the figures hold rate, age, rejects and drops of each sensor, and the times of each stage") {
  HealthMonitor monitor{Config{}};
  static_cast<void>(report_of(monitor, working(kStart, true)));
  StatusSnapshot status = working(kStart + kSecond, true);
  status.prior.counters.imu_bad_value = 3;
  status.prior.dropped[0] = 4;
  status.registration.pose.p_map_m = {1.0, 2.0, 3.0};
  status.prior.barometers.height_bias_m = 0.5;
  const HealthReport report = report_of(monitor, status);
  REQUIRE(report.status.sensor_count == 5);
  const ipc::SensorStatus& imu = report.status.sensors[1];
  CHECK(std::string(imu.name) == "imu");
  CHECK(imu.rate_hz == doctest::Approx(100.0));
  CHECK(imu.age_s == doctest::Approx(0.0));
  CHECK(imu.rejected == 3);
  CHECK(imu.dropped == 4);
  CHECK(report.status.pose.z_m == 3.0);
  CHECK(report.status.height.bias_m == 0.5);
  CHECK(std::string(report.status.height.source) == "differential");
  REQUIRE(report.status.stage_count == 4);
  CHECK(std::string(report.status.stages[2].name) == "registration");
  CHECK(report.status.stages[2].median_ms == doctest::Approx(2.0).epsilon(0.1));  // a bucket is 19 % wide
}

TEST_CASE("weak directions are named, with who holds them; a direction that nothing measures is a warning") {
  HealthMonitor monitor{Config{}};
  StatusSnapshot status = working(kStart, true);
  Localisability& known = status.registration.localisability;
  known.count = 3;
  known.directions[0].axis = {0.5F, 0.866F, 0.0F, 0.0F, 0.0F, 0.0F};
  known.directions[0].strength = 0.02F;
  known.directions[0].holder = Holder::kWheels;
  known.directions[1].strength = known.directions[2].strength = 1.0F;
  const HealthReport held = report_of(monitor, status);
  const ipc::HealthEntry& said = entry(held, "registration/localisability");
  CHECK(said.level == HealthLevel::kOk);
  CHECK(std::string(said.message) == "along 60 deg: 2 % of localisability, held by wheels");
  CHECK(said.value == doctest::Approx(0.02));

  known.directions[0].axis = {0.0F, 0.0F, -1.0F, 0.0F, 0.0F, 0.0F};
  known.directions[0].holder = Holder::kMotion;
  const HealthReport open = report_of(monitor, status);
  CHECK(entry(open, "registration/localisability").level == HealthLevel::kWarning);
  CHECK(std::string(entry(open, "registration/localisability").message).starts_with("z: 2 %"));

  known.directions[0].strength = 0.9F;
  const HealthReport strong = report_of(monitor, status);
  CHECK(std::string(entry(strong, "registration/localisability").message) ==
        "the scans hold every direction");
}

TEST_CASE("a base station that the prior stage says to drift is named by the altimeter's entry") {
  HealthMonitor monitor{Config{}};
  StatusSnapshot status = working(kStart, true);
  status.registration.effective_method = Method::kAdaptive;
  status.registration.altimeter.bias_m = 0.02;
  status.registration.altimeter.bias_sd_m = 0.05;
  CHECK(entry(report_of(monitor, status), "altimeter").level == HealthLevel::kOk);

  // 5 Pa/s: its samples are refused, so that the map sees no drift.
  status.prior.barometers.base[0] = BarometerFault::kDrifting;
  const HealthReport said = report_of(monitor, status);
  CHECK(entry(said, "altimeter").level == HealthLevel::kWarning);
  CHECK(std::string(entry(said, "altimeter").message) ==
        "the base station's barometer drifts, bias 0.02 m; check it; the height follows the scans");

  status.prior.barometers.base[0] = BarometerFault::kOk;
  status.prior.barometers.base[1] = BarometerFault::kDrifting;
  const HealthReport second = report_of(monitor, status);
  CHECK(std::string(entry(second, "altimeter").message)
            .starts_with("the second base station's barometer drifts"));

  status.prior.barometers.robot = BarometerFault::kDrifting;
  const HealthReport robot = report_of(monitor, status);
  CHECK(std::string(entry(robot, "altimeter").message).starts_with("the robot's barometer drifts"));
}

TEST_CASE("the airflow's coefficient is an entry of its own where it is estimated") {
  HealthMonitor monitor{Config{}};
  StatusSnapshot status = working(kStart, true);
  status.registration.effective_method = Method::kAdaptive;
  status.registration.altimeter.airflow_s2_m = 0.017;
  status.registration.altimeter.airflow_sd_s2_m = 0.0021;
  const HealthReport report = report_of(monitor, status);
  CHECK(std::string(entry(report, "altimeter/airflow").message) ==
        "+17.0 mm per (m/s)^2, sd 2.1: the robot's own wind at its barometer, corrected");
  CHECK(entry(report, "altimeter/airflow").value == 0.017);
}

}  // namespace isobar::test::test_robot_health

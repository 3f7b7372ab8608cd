// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>

#include "core/names.hpp"
#include "core/stamp.hpp"
#include "daemon/base_station_health.hpp"
#include "daemon/contradictions.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/imu_source.hpp"
#include "daemon/input_health.hpp"
#include "daemon/run_health.hpp"
#include "daemon/stage_settings.hpp"
#include "daemon/status_figures.hpp"
#include "daemon/timing_health.hpp"
#include "daemon/wheel_source.hpp"

namespace isobar {

namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

/// Inputs that may deliver samples of this kind.
std::string input_of(const Config& config, datagram::Kind kind) {
  using datagram::Kind;
  const bool by_dds = (kind == Kind::kImu && config.imu.source == ImuSource::kDds) ||
                      (kind == Kind::kPressure && config.barometer.source == BarometerSource::kDds) ||
                      (kind == Kind::kWheel && config.wheel.source == WheelSource::kDds);
  if (by_dds) return "DDS";
  if (kind == Kind::kImu && config.imu.source == ImuSource::kLidar) {
    const int port = info_port_of(config.lidar);
    return "UDP port " + std::to_string(port != 0 ? port : config.lidar.port) + ", from the lidar";
  }
  if (kind == Kind::kPressure && config.barometer.source == BarometerSource::kImu) return "the IMU";
  const bool both = kind == Kind::kBasePressure && config.dds.receive_base_pressure;
  return "UDP port " + std::to_string(config.input.port) + (both ? " or over DDS" : "");
}

std::string lost_text(const RegistrationStatus& registration) {
  return fmt::format("lost since {:.1f} s: {}; dead reckoning, not mapped",
                     seconds_between(registration.lost_since_ns, registration.pose.stamp_ns),
                     kLostReasonTexts.name(registration.lost));
}

constexpr NameTable<BarometerFault, 6> kBarometerFaultTexts{{{
    {BarometerFault::kOk, "ok"},
    {BarometerFault::kOff, "off: silent"},
    {BarometerFault::kStuck, "stuck: its value does not change by a single bit"},
    {BarometerFault::kSpiking, "spiking: single values jump repeatedly"},
    {BarometerFault::kDrifting, "drifting: neither weather nor the height changes so"},
    {BarometerFault::kWrong, "wrong: impossible values, or a jump that neither motion nor weather explains"},
}}};

}  // namespace

void HealthMonitor::fill_deadlines(const StatusSnapshot& now, HealthReport& report) const {
  add_deadline(report, "lidar/deadline", now.lidar.punctuality, last_.lidar.punctuality, "scans", now.now_ns);
  add_deadline(report, "prior/deadline", now.prior.punctuality, last_.prior.punctuality, "priors",
               now.now_ns);
  add_deadline(report, "registration/deadline", now.registration.punctuality, last_.registration.punctuality,
               "poses", now.now_ns);
  add_deadline(report, "map/deadline", now.map.punctuality, last_.map.punctuality, "updates", now.now_ns);
  // Only with locked memory, where no page fault should occur after the warm-up.
  if (config_.realtime.enabled) {
    add_count(report, "registration/page_faults", now.registration.page_faults,
              last_.registration.page_faults, "page faults of the registration, some microseconds each");
  }
}

HealthMonitor::HealthMonitor(const Config& config)
    : config_(config), times_(std::make_unique<StageTimes>()) {}

HealthMonitor::~HealthMonitor() = default;

void HealthMonitor::fill(const StatusSnapshot& now, HealthReport& report) {
  const double elapsed_s = last_.now_ns == 0 ? 1.0 : seconds_between(last_.now_ns, now.now_ns);
  fill_lidar(now, elapsed_s, report);
  fill_samples(now, elapsed_s, report);
  add_starts_over(report, start_over_, now.now_ns);
  add_contradictions(report, now.contradictions);
  fill_faults(now, report);
  fill_prior(now, report);
  fill_registration(now, report);
  fill_map(now, report);
  fill_deadlines(now, report);
  fill_robot_figures(now, last_, *times_, report.status);
  log_hint(now, last_);
  last_ = now;
}

void HealthMonitor::fill_samples(const StatusSnapshot& now, double elapsed_s, HealthReport& report) const {
  constexpr const char* kNames[] = {"imu", "barometer", "base_station",
                                    "wheels"};  // NOLINT(modernize-avoid-c-arrays)
  const auto& counters = now.samples.counters;
  const auto& before = last_.samples.counters;
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    const double rate_hz = per_second(now.prior.samples[kind], last_.prior.samples[kind], elapsed_s);
    const auto which = static_cast<datagram::Kind>(kind);
    // A fault of the device comes before a contradiction of its samples.
    const bool has_fault = now.imu.present && now.imu.device.fault[0] != '\0';
    if (which == datagram::Kind::kImu && !has_fault && !usable_sensors(now.contradictions).imu) {
      add_entry(report, kNames[kind], HealthLevel::kWarning,
                "samples come and are not used: see the contradictions", rate_hz);
    } else if (which == datagram::Kind::kImu && !config_.imu.present()) {
      add_absent(report, kNames[kind], "imu.source", now.prior.samples[kind] + now.samples.refused[kind]);
    } else if (which == datagram::Kind::kPressure && !config_.barometer.present()) {
      add_absent(report, kNames[kind], "barometer.source", now.samples.refused[kind]);
    } else if (which == datagram::Kind::kWheel && !config_.wheel.present()) {
      add_absent(report, kNames[kind], "wheel.source", now.samples.refused[kind]);
    } else if (which == datagram::Kind::kPressure && now.barometer.present) {
      add_device(report, kNames[kind], barometer_period_ns(config_.barometer), now.barometer, last_.barometer,
                 now.now_ns, rate_hz);
    } else if (which == datagram::Kind::kImu && now.imu.present) {
      add_device(report, kNames[kind], imu_period_ns(config_.imu), now.imu, last_.imu, now.now_ns, rate_hz);
    } else if (which == datagram::Kind::kWheel && now.wheels.present) {
      add_device(report, kNames[kind], wheel_period_ns(config_.wheel), now.wheels, last_.wheels, now.now_ns,
                 rate_hz, kLostEdges);
    } else if (which == datagram::Kind::kBasePressure) {
      fill_base_stations(now, report);
    } else {
      const bool expected = which != datagram::Kind::kWheel || config_.input.expect_wheels;
      add_stream(report, kNames[kind], now.prior.last_sample_ns[kind], now.now_ns, kSensorSilenceNs, rate_hz,
                 input_of(config_, which), expected);
    }
    add_timing(report, kNames[kind], now.prior.arrivals[kind].figures(now.now_ns));
    add_count(report, (std::string(kNames[kind]) + "/lost").c_str(), counters.lost[kind], before.lost[kind],
              "samples lost, by the gaps in their numbers");
  }
  if (!now.samples_wait_for.empty()) {
    add_entry(report, "input", HealthLevel::kError, "waiting: " + now.samples_wait_for, 0.0);
  }
  add_input(report, now.samples, last_.samples);
  add_sample_senders(report, now.samples, last_.samples, now.now_ns);
  add_paths(report, "imu", now.prior.imu_path, now.now_ns);
  add_paths(report, "wheels", now.prior.wheel_path, now.now_ns);
  add_slip(report, now.prior.counters, last_.prior.counters);
  add_count(report, "input/dropped", now.prior.dropped_samples, last_.prior.dropped_samples,
            "samples dropped: they arrived faster than they were used");
}

// A base station may send once a second or less; its limit of silence comes from its own cadence.
void HealthMonitor::fill_base_stations(const StatusSnapshot& now, HealthReport& report) const {
  constexpr std::array<const char*, 2> kNames = {"base_station", "second_base_station"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const Cadence& cadence = now.prior.base_stations[i];
    if (i > 0 && !cadence.started() && config_.dds.second_base_station.empty()) continue;
    const double rate_hz = cadence.interval_ns() > 0 ? 1e9 / static_cast<double>(cadence.interval_ns()) : 0.0;
    // A second base station is named in the configuration, hence expected.
    add_stream(report, kNames[i], cadence.last_ns(), now.now_ns, cadence.limit_ns(), rate_hz,
               input_of(config_, datagram::Kind::kBasePressure), i > 0 || config_.input.expect_base_station);
    add_paths(report, kNames[i], now.prior.base_paths[i], now.now_ns);
  }
  add_base_station_counts("base_station", now.samples.base, last_.samples.base,
                          [&report](const std::string& name, HealthLevel level, const std::string& message,
                                    double value) { add_entry(report, name, level, message, value); });
}

// Faults detected from the values of the samples; silence is reported by the entry of the stream.
void HealthMonitor::fill_faults(const StatusSnapshot& now, HealthReport& report) {
  const BarometerHealth& health = now.prior.barometers;
  // Without IMU samples the barometers are not judged.
  const bool judged = now.now_ns - now.prior.stamp_ns <= kSensorSilenceNs;
  const auto add = [&report, judged](const char* name, BarometerFault fault) {
    // Silence is already an error of the stream.
    const HealthLevel level = !judged || fault == BarometerFault::kOff ? HealthLevel::kStale
                              : fault == BarometerFault::kOk           ? HealthLevel::kOk
                                                                       : HealthLevel::kWarning;
    add_entry(report, name, level, judged ? kBarometerFaultTexts.name(fault) : "not judged without an IMU",
              static_cast<double>(fault));
  };
  if (now.prior.counters.pressure_accepted > 0) add("barometer/fault", health.robot);
  if (health.base_heard[0]) add("base_station/fault", health.base[0]);
  if (health.base_heard[1]) add("second_base_station/fault", health.base[1]);
  constexpr std::array<const char*, 3> kThermometers = {"barometer/temperature", "base_station/temperature",
                                                        "second_base_station/temperature"};
  for (std::size_t i = 0; i < kThermometers.size(); ++i) {
    if (now.prior.counters.thermometer_faults == 0 || (i > 0 && !health.base_heard[i - 1])) continue;
    const bool wrong = health.thermometer_wrong[i];
    add_entry(
        report, kThermometers[i],
        !judged ? HealthLevel::kStale
        : wrong ? HealthLevel::kWarning
                : HealthLevel::kOk,
        wrong ? "contradicts the other thermometer or stepped: left out of the air temperature" : "used",
        0.0);
  }
  if (!health.base_heard[0] || !health.base_heard[1]) return;
  const char* sentence = health.base_undecided      ? "both send and disagree; which one is wrong is unknown"
                         : health.base_usable == 2  ? "both agree"
                         : health.base_usable == 0  ? "none is usable: the last pressure is held"
                         : health.base_active == 0U ? "only the first is usable"
                                                    : "only the second is usable";
  const bool well = health.base_usable == 2 && !health.base_undecided;
  const HealthLevel level = !judged ? HealthLevel::kStale : well ? HealthLevel::kOk : HealthLevel::kWarning;
  add_entry(report, "base_stations", level, judged ? sentence : "not judged without an IMU",
            health.base_usable);
}

void HealthMonitor::fill_registration(const StatusSnapshot& now, HealthReport& report) {
  const RegistrationStatus& registration = now.registration;
  const std::int64_t pose_ns = registration.pose.stamp_ns;
  const bool stale = pose_ns == 0 || now.now_ns - pose_ns > kStageSilenceNs;
  const bool idle = now.now_ns - registration.punctuality.last_ns > kStageSilenceNs;
  if (stale) {
    add_entry(report, "registration", HealthLevel::kStale,
              pose_ns == 0 ? "waiting for the first scan" : silence_text("pose", pose_ns, now.now_ns), 0.0);
  } else if (registration.lost != LostReason::kNone) {
    add_entry(report, "registration", HealthLevel::kError, lost_text(registration), registration.overlap);
  } else {
    add_entry(report, "registration",
              registration.mode == PoseMode::kRegistered ? HealthLevel::kOk : HealthLevel::kWarning,
              fmt::format("mode: {}, method: {}, overlap {:.2f}", kPoseModeNames.name(registration.mode),
                          kMethodNames.name(registration.effective_method), registration.overlap),
              registration.overlap);
    if (registration.mode == PoseMode::kRegistered) {
      add_localisability(report, registration.localisability);
    }
  }
  if (registration.scans > 0) {
    add_entry(report, "registration/ms", idle ? HealthLevel::kStale : HealthLevel::kOk,
              "CPU time of the last scan", registration.registration_ms);
  }
  fill_adaptive(now, report);
  add_count(report, "registration/refused", registration.from_prior, last_.registration.from_prior,
            "scans that did not match the map; their poses are the prior's");
  add_count(report, "registration/dropped", registration.dropped_scans, last_.registration.dropped_scans,
            "scans dropped for a newer one; their poses are the prior's");
  add_count(report, "registration/priors_dropped", registration.dropped_priors,
            last_.registration.dropped_priors, "priors lost to a full queue of the registration");
  add_count(report, "registration/bridged", registration.bridged, last_.registration.bridged,
            "poses from the prior while the lidar was silent");
}

void HealthMonitor::fill_map(const StatusSnapshot& now, HealthReport& report) const {
  add_run_entries(now, report);
  const std::int64_t last_ns = now.map.punctuality.last_ns;
  const bool stale = last_ns == 0 || now.now_ns - last_ns > kStageSilenceNs;
  const std::string text = last_ns == 0 ? "waiting for the first scan"
                           : stale      ? silence_text("scan", last_ns, now.now_ns)
                                        : "cells in memory";
  add_entry(report, "map", stale ? HealthLevel::kStale : HealthLevel::kOk, text,
            static_cast<double>(now.map.cells));
  if (last_ns != 0) {
    add_entry(report, "map/ms", stale ? HealthLevel::kStale : HealthLevel::kOk, "CPU time of the last update",
              now.map.update_ms);
  }
  add_count(report, "map/dropped", now.map.dropped_scans, last_.map.dropped_scans,
            "scans that the map skipped for a newer one");
}

}  // namespace isobar

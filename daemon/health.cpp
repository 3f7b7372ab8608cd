// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "tools/report/replay_output.hpp"

namespace isobar {

namespace {

using ipc::HealthLevel;
using ipc::HealthReport;

constexpr std::int64_t kSilenceNs = 1'000'000'000;
constexpr std::int64_t kReportEveryNs = 1'000'000'000;

/// Time between two samples of a barometer of this machine.
std::int64_t period_ns(const BarometerSettings& barometer) {
  const int rate_hz = barometer.source == "dps310"     ? barometer.dps310.pressure_rate_hz
                      : barometer.source == "setra278" ? barometer.setra278.device.rate_hz
                                                       : barometer.iio.rate_hz;
  return 1'000'000'000 / rate_hz;
}

double per_second(std::uint64_t now, std::uint64_t before, double elapsed_s) {
  return elapsed_s > 0.0 ? static_cast<double>(now - before) / elapsed_s : 0.0;
}

/// An entry for a count that should be zero.
void add_count(HealthReport& report, const char* name, std::uint64_t now, std::uint64_t before,
               const char* sentence) {
  if (now == 0) return;
  report.add(name, now > before ? HealthLevel::kWarning : HealthLevel::kOk, sentence,
             static_cast<double>(now));
}

/// Where samples of this kind may come from.
std::string input_of(const Config& config, datagram::Kind kind) {
  using datagram::Kind;
  const bool by_dds = kind == Kind::kBasePressure
                          ? config.dds.receive_base_pressure
                          : config.dds.receive_sensors && (kind == Kind::kImu || kind == Kind::kWheel);
  return "UDP port " + std::to_string(config.input.port) + (by_dds ? " or over DDS" : "");
}

void add_stream(HealthReport& report, const std::string& name, std::int64_t last_ns, std::int64_t now_ns,
                double rate_hz, const std::string& where) {
  if (last_ns == 0) {
    report.add(name, HealthLevel::kStale, "nothing received yet on " + where, 0.0);
  } else if (now_ns - last_ns > kSilenceNs) {
    const double silent_s = static_cast<double>(now_ns - last_ns) * 1e-9;
    report.add(name, HealthLevel::kError, fmt::format("silent for {:.0f} s on {}", silent_s, where), 0.0);
  } else {
    report.add(name, HealthLevel::kOk, fmt::format("{:.1f} per second", rate_hz), rate_hz);
  }
}

const char* sentence_of(BarometerFault fault) {
  switch (fault) {
    case BarometerFault::kOk:
      return "well";
    case BarometerFault::kOff:
      return "off: silent";
    case BarometerFault::kStuck:
      return "stuck: its value does not change by one bit";
    case BarometerFault::kSpiking:
      return "spiking: single values jump again and again";
    case BarometerFault::kDrifting:
      return "drifting: it moves as no weather and no height does";
    case BarometerFault::kWrong:
      return "wrong: its values are impossible, or have jumped to where nothing can have brought them";
  }
  return "unknown";
}

}  // namespace

HealthMonitor::HealthMonitor(const Config& config, std::vector<std::string> realtime_refusals)
    : config_(config), refusals_(std::move(realtime_refusals)) {}

bool HealthMonitor::due(const StatusSnapshot& now) {
  if (first_look_ns_ == 0) first_look_ns_ = now.now_ns;
  if (last_.now_ns == 0) return now.now_ns - first_look_ns_ >= kReportEveryNs;
  return now.now_ns - last_.now_ns >= kReportEveryNs ||
         now.barometer.device.state != last_.barometer.device.state;
}

void HealthMonitor::fill(const StatusSnapshot& now, HealthReport& report) {
  const double elapsed_s = last_.now_ns == 0 ? 1.0 : static_cast<double>(now.now_ns - last_.now_ns) * 1e-9;
  report.stamp_ns = now.now_ns;
  report.entry_count = 0;
  fill_lidar(now, elapsed_s, report);
  fill_samples(now, elapsed_s, report);
  fill_faults(now, report);
  fill_estimate(now, report);
  for (std::size_t i = 0; i < refusals_.size(); ++i) {  // numbered: news() knows an entry by its name
    report.add("realtime/" + std::to_string(i + 1), HealthLevel::kWarning, refusals_[i], 0.0);
  }
  last_ = now;
}

void HealthMonitor::fill_lidar(const StatusSnapshot& now, double elapsed_s, HealthReport& report) const {
  const auto& counters = now.lidar.counters;
  const auto& before = last_.lidar.counters;
  add_stream(report, "lidar", now.lidar.last_packet_ns, now.now_ns,
             per_second(counters.scans, before.scans, elapsed_s),
             "UDP port " + std::to_string(config_.lidar.port));
  if (counters.wrong_model > before.wrong_model) {
    report.add("lidar/model", HealthLevel::kError, now.lidar.wrong_model_message.data(),
               static_cast<double>(counters.wrong_model));
  }
  add_count(report, "lidar/packets_lost", counters.lost, before.lost,
            "packets missing, by the sensor's own time");
  add_count(report, "lidar/garbage", counters.garbage + counters.truncated + counters.oversized,
            before.garbage + before.truncated + before.oversized,
            "packets that are none of the lidar's, refused");
  add_count(report, "lidar/reordered", counters.reordered + counters.duplicated,
            before.reordered + before.duplicated, "packets that came twice or out of order");
  add_count(report, "lidar/dropped_by_kernel", now.lidar.dropped_by_kernel, last_.lidar.dropped_by_kernel,
            "datagrams dropped by the kernel: the machine is too busy");
  add_count(report, "lidar/no_memory", now.lidar.scans_without_memory, last_.lidar.scans_without_memory,
            "scans dropped: no free chunk of shared memory");
}

void HealthMonitor::fill_samples(const StatusSnapshot& now, double elapsed_s, HealthReport& report) const {
  constexpr const char* kNames[] = {"imu", "barometer", "base_station",
                                    "wheels"};  // NOLINT(modernize-avoid-c-arrays)
  const auto& counters = now.inertial.counters;
  const auto& before = last_.inertial.counters;
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    const double rate_hz = per_second(now.prior.samples[kind], last_.prior.samples[kind], elapsed_s);
    const auto which = static_cast<datagram::Kind>(kind);
    if (which == datagram::Kind::kPressure && now.barometer.present) {
      fill_barometer(now, rate_hz, report);
    } else {
      add_stream(report, kNames[kind], now.prior.last_sample_ns[kind], now.now_ns, rate_hz,
                 input_of(config_, which));
    }
    add_count(report, (std::string(kNames[kind]) + "/lost").c_str(), counters.lost[kind], before.lost[kind],
              "samples missing, by their numbers");
  }
  add_count(report, "input/refused", counters.malformed + counters.implausible + counters.unknown_kind,
            before.malformed + before.implausible + before.unknown_kind,
            "lines malformed or implausible, refused");
  add_count(report, "input/clock_steps", now.inertial.clock_steps, last_.inertial.clock_steps,
            "a sender's clock was set");
  add_count(report, "input/dropped_by_kernel", now.inertial.dropped_by_kernel,
            last_.inertial.dropped_by_kernel, "datagrams dropped by the kernel: the machine is too busy");
  add_count(report, "input/no_memory", now.inertial.samples_without_memory,
            last_.inertial.samples_without_memory, "samples dropped: no free chunk of shared memory");
  add_count(report, "input/dropped", now.prior.dropped_samples, last_.prior.dropped_samples,
            "samples that came faster than they could be used");
}

void HealthMonitor::fill_barometer(const StatusSnapshot& now, double rate_hz, HealthReport& report) const {
  const BarometerStatus& device = now.barometer.device;
  const std::string place = now.barometer.place.data();
  const std::int64_t age_ns = now.now_ns - device.last_sample_ns;
  if (device.state == BarometerState::kStarting) {
    report.add("barometer", HealthLevel::kStale, place + ": starting", 0.0);
  } else if (device.state != BarometerState::kMeasuring) {
    report.add("barometer", HealthLevel::kError, place + ": " + device.fault.data(), 0.0);
  } else if (age_ns > kSilenceNs + period_ns(config_.barometer)) {
    // The thread itself hangs in the kernel, or gets no processor.
    report.add("barometer", HealthLevel::kError,
               fmt::format("{}: silent for {:.0f} s", place, static_cast<double>(age_ns) * 1e-9), 0.0);
  } else {
    report.add("barometer", HealthLevel::kOk, fmt::format("{:.1f} per second from {}", rate_hz, place),
               rate_hz);
  }
  const BarometerCounters& before = last_.barometer.device.counters;
  add_count(report, "barometer/io_errors", device.counters.io_errors, before.io_errors,
            "accesses that failed");
  add_count(report, "barometer/resets", device.counters.resets, before.resets,
            "times that the sensor lost its settings: is its power sound?");
  add_count(report, "barometer/implausible", device.counters.implausible, before.implausible,
            "readings that cannot be air pressure, refused");
  add_count(report, "barometer/refused", now.inertial.refused_pressure, last_.inertial.refused_pressure,
            ("baro lines refused: barometer.source is " + config_.barometer.source).c_str());
  add_count(report, "barometer/no_memory", now.barometer.samples_without_memory,
            last_.barometer.samples_without_memory, "samples dropped: no free chunk of shared memory");
}

// Silence of a stream is said by its own entry; here is what the values themselves say.
void HealthMonitor::fill_faults(const StatusSnapshot& now, HealthReport& report) {
  const BarometerHealth& health = now.prior.barometers;
  const auto add = [&report](const char* name, BarometerFault fault) {
    // Silence is an error already, of the stream.
    const bool well = fault == BarometerFault::kOk || fault == BarometerFault::kOff;
    report.add(name, well ? HealthLevel::kOk : HealthLevel::kWarning, sentence_of(fault),
               static_cast<double>(fault));
  };
  if (now.prior.counters.pressure_accepted > 0) add("barometer/fault", health.robot);
  if (health.base_heard[0]) add("base_station/fault", health.base[0]);
  if (health.base_heard[1]) add("base_station_2/fault", health.base[1]);
  if (!health.base_heard[0] || !health.base_heard[1]) return;
  const char* sentence = health.base_undecided ? "both are there and disagree, nobody can tell which is wrong"
                         : health.base_usable == 2  ? "both agree"
                         : health.base_usable == 0  ? "none is left: the last pressure is held"
                         : health.base_active == 0U ? "only the first is left"
                                                    : "only the second is left";
  const bool well = health.base_usable == 2 && !health.base_undecided;
  report.add("base_stations", well ? HealthLevel::kOk : HealthLevel::kWarning, sentence, health.base_usable);
}

void HealthMonitor::fill_estimate(const StatusSnapshot& now, HealthReport& report) const {
  const PriorStatus& prior = now.prior;
  const PriorCounters& used = prior.counters;
  const PriorCounters& before = last_.prior.counters;
  constexpr const char* kOutside = "samples outside of the calibrated range: the nearest correction was used";
  constexpr const char* kNoTemperature =
      "samples without the temperature that the calibration needs: the last known was used";
  add_count(report, "barometer/outside_calibration", used.pressure_outside_calibration,
            before.pressure_outside_calibration, kOutside);
  add_count(report, "barometer/no_temperature", used.pressure_without_temperature,
            before.pressure_without_temperature, kNoTemperature);
  add_count(report, "base_station/outside_calibration", used.base_outside_calibration,
            before.base_outside_calibration, kOutside);
  add_count(report, "base_station/no_temperature", used.base_without_temperature,
            before.base_without_temperature, kNoTemperature);
  report.add("attitude", prior.attitude_valid ? HealthLevel::kOk : HealthLevel::kStale,
             prior.attitude_valid ? "gravity found" : "gravity not found yet, it needs the IMU", 0.0);
  const bool height_good = prior.height_source == HeightSource::kDifferential;
  report.add("height", height_good ? HealthLevel::kOk : HealthLevel::kWarning,
             fmt::format("source: {}, sd {:.3f} m", report::height_source_name(prior.height_source),
                         std::sqrt(prior.height_variance_m2)),
             prior.height_m);

  const RegistrationStatus& registration = now.registration;
  const bool good = registration.mode == PoseMode::kRegistered;
  const HealthLevel level = registration.scans == 0 ? HealthLevel::kStale
                            : good                  ? HealthLevel::kOk
                                                    : HealthLevel::kWarning;
  report.add("registration", level,
             fmt::format("mode: {}, method: {}, overlap {:.2f}{}", report::mode_name(registration.mode),
                         report::method_name(registration.effective_method), registration.overlap,
                         registration.degenerate ? ", degenerate" : ""),
             registration.overlap);
  report.add("registration/ms", HealthLevel::kOk, "CPU time of the last scan", registration.registration_ms);
  add_count(report, "registration/refused", registration.from_prior, last_.registration.from_prior,
            "scans that did not fit the map; their pose is the prior's");
  add_count(report, "registration/dropped", registration.dropped_scans, last_.registration.dropped_scans,
            "scans dropped: they came faster than they could be registered");
  add_count(report, "registration/priors_dropped", registration.dropped_priors,
            last_.registration.dropped_priors, "priors that the registration did not get");
  add_count(report, "registration/bridged", registration.bridged, last_.registration.bridged,
            "poses without a scan: the lidar was silent");
  report.add("map", HealthLevel::kOk, "cells in memory", static_cast<double>(now.map.cells));
  report.add("map/ms", HealthLevel::kOk, "CPU time of the last update", now.map.update_ms);
  add_count(report, "map/dropped", now.map.dropped_scans, last_.map.dropped_scans,
            "scans that the map did not get");
}

std::vector<std::string> HealthMonitor::news(const HealthReport& report) {
  constexpr const char* kWords[] = {"ok", "warning", "error", "waiting"};  // NOLINT(modernize-avoid-c-arrays)
  std::vector<std::string> lines;
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    const std::string name = entry.name;
    auto known =
        std::find_if(levels_.begin(), levels_.end(), [&](const auto& pair) { return pair.first == name; });
    if (known == levels_.end()) {
      levels_.emplace_back(name, HealthLevel::kOk);
      known = levels_.end() - 1;
      // Figures that are well from the start are no news.
      if (entry.level == HealthLevel::kOk && name.find('/') != std::string::npos) continue;
    } else if (known->second == entry.level) {
      continue;
    }
    known->second = entry.level;
    lines.push_back(name + ": " + kWords[static_cast<std::size_t>(entry.level)] + ": " + entry.message);
  }
  return lines;
}

}  // namespace isobar

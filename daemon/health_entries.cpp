// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/health_entries.hpp"

#include <spdlog/fmt/fmt.h>

#include "core/stamp.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {

using ipc::HealthLevel;
using ipc::HealthReport;

std::int64_t barometer_period_ns(const BarometerSettings& barometer) {
  const int rate_hz = barometer.rate_hz();
  return rate_hz > 0 ? 1'000'000'000 / rate_hz : 0;
}

double per_second(std::uint64_t now, std::uint64_t before, double elapsed_s) {
  return elapsed_s > 0.0 ? static_cast<double>(now - before) / elapsed_s : 0.0;
}

std::string silence_text(const char* what, std::int64_t last_ns, std::int64_t now_ns) {
  return fmt::format("no {} for {:.0f} s", what, seconds_between(last_ns, now_ns));
}

void add_count(HealthReport& report, const char* name, std::uint64_t now, std::uint64_t before,
               const char* sentence) {
  if (now == 0) return;
  add_entry(report, name, now > before ? HealthLevel::kWarning : HealthLevel::kOk, sentence,
            static_cast<double>(now));
}

void add_deadline(HealthReport& report, const char* name, const DeadlineStatus& now,
                  const DeadlineStatus& before, const char* what, std::int64_t now_ns) {
  if (now.outputs == 0) return;
  if (const std::int64_t age_ns = now_ns - now.last_ns; age_ns > kStageSilenceNs) {
    add_entry(report, name, HealthLevel::kStale,
              fmt::format("no {} for {:.0f} s", what, static_cast<double>(age_ns) * 1e-9),
              static_cast<double>(now.misses));
    return;
  }
  add_entry(report, name, now.misses > before.misses ? HealthLevel::kWarning : HealthLevel::kOk,
            fmt::format("{} of {} {} later than {:.1f} ms, at most {:.1f} ms", now.misses, now.outputs, what,
                        static_cast<double>(now.limit_ns) * 1e-6, static_cast<double>(now.worst_ns) * 1e-6),
            static_cast<double>(now.misses));
}

void add_stream(HealthReport& report, const std::string& name, std::int64_t last_ns, std::int64_t now_ns,
                std::int64_t silence_ns, double rate_hz, const std::string& where, bool expected) {
  if (last_ns == 0 && !expected) {
    add_entry(report, name, HealthLevel::kOk, "none: never heard on " + where, 0.0);
  } else if (last_ns == 0) {
    add_entry(report, name, HealthLevel::kStale, "nothing received yet on " + where, 0.0);
  } else if (now_ns - last_ns > silence_ns) {
    const double silent_s = seconds_between(last_ns, now_ns);
    constexpr double kTenthsBelowS = 10.0;
    add_entry(report, name, HealthLevel::kError,
              fmt::format("silent for {:.{}f} s on {}", silent_s, silent_s < kTenthsBelowS ? 1 : 0, where),
              0.0);
  } else {
    add_entry(report, name, HealthLevel::kOk, fmt::format("{:.1f} per second", rate_hz), rate_hz);
  }
}

void add_absent(HealthReport& report, const std::string& name, const char* key, std::uint64_t samples) {
  const std::string why = std::string(key) + " is \"none\"";
  if (samples > 0) {
    add_entry(report, name, HealthLevel::kWarning, "samples come and are not used: " + why,
              static_cast<double>(samples));
  } else {
    add_entry(report, name, HealthLevel::kOk, "none: " + why, 0.0);
  }
}

void add_device(HealthReport& report, const std::string& name, std::int64_t period_ns,
                const DeviceThreadStatus& now, const DeviceThreadStatus& before, std::int64_t now_ns,
                double rate_hz, const CorruptWords& corrupt) {
  const DeviceStatus& device = now.device;
  const std::string place = now.place.data();
  const std::int64_t age_ns = now_ns - device.last_sample_ns;
  if (device.state == DeviceState::kStarting) {
    add_entry(report, name, HealthLevel::kStale, place + ": starting", 0.0);
  } else if (device.state != DeviceState::kMeasuring) {
    add_entry(report, name, HealthLevel::kError, place + ": " + device.fault.data(), 0.0);
  } else if (age_ns > kSensorSilenceNs + period_ns) {
    // The thread hangs in the kernel or gets no processor time.
    add_entry(report, name, HealthLevel::kError,
              fmt::format("{}: silent for {:.0f} s", place, static_cast<double>(age_ns) * 1e-9), 0.0);
  } else {
    add_entry(report, name, HealthLevel::kOk, fmt::format("{:.1f} per second from {}", rate_hz, place),
              rate_hz);
  }
  if (device.note[0] != '\0') add_entry(report, name + "/note", HealthLevel::kOk, device.note.data(), 0.0);
  const DeviceCounters& earlier = before.device.counters;
  const auto count = [&](const char* what, std::uint64_t value, std::uint64_t value_before,
                         const char* sentence) {
    add_count(report, (name + what).c_str(), value, value_before, sentence);
  };
  count("/io_errors", device.counters.io_errors, earlier.io_errors, "accesses that failed");
  count("/resets", device.counters.resets, earlier.resets,
        "resets of the sensor: it lost its settings, check its power supply");
  count("/implausible", device.counters.implausible, earlier.implausible,
        "readings outside of the plausible range, refused");
  count(corrupt.entry, device.counters.corrupt, earlier.corrupt, corrupt.sentence);
  count("/no_memory", now.samples_without_memory, before.samples_without_memory,
        "samples dropped: no free chunk of shared memory");
}

void add_slip(HealthReport& report, const PriorCounters& now, const PriorCounters& before) {
  add_count(
      report, "wheels/turn_slip", now.wheel_turn_slips, before.wheel_turn_slips,
      "seconds in which the wheels turned otherwise than the gyro: a wheel slips, or the robot is moved");
  add_count(report, "wheels/speed_slip", now.wheel_speed_slips, before.wheel_speed_slips,
            "seconds in which the accelerometer contradicted the wheels: they block or stand while the robot "
            "moves on");
  if (now.wheel_bad_variance == 0) return;
  add_entry(report, "wheels/covariance", HealthLevel::kOk,
            "samples with a covariance that no wheels have: attitude.wheel_sigma_m_s is used",
            static_cast<double>(now.wheel_bad_variance));
}

void add_calibration(HealthReport& report, const std::string& sensor, std::uint64_t outside,
                     std::uint64_t outside_before, std::uint64_t without_temperature,
                     std::uint64_t without_temperature_before) {
  add_count(report, (sensor + "/outside_calibration").c_str(), outside, outside_before,
            "samples outside of the calibrated range, corrected as at its edge");
  add_count(report, (sensor + "/no_temperature").c_str(), without_temperature, without_temperature_before,
            "samples without a temperature, calibrated with the last known one");
}

void add_input(HealthReport& report, const SampleThreadStatus& now, const SampleThreadStatus& before) {
  const auto& counters = now.counters;
  const auto& earlier = before.counters;
  add_count(report, "input/refused", counters.malformed + counters.implausible + counters.unknown_kind,
            earlier.malformed + earlier.implausible + earlier.unknown_kind,
            "lines malformed or implausible, refused");
  constexpr auto kWords = std::to_array<std::array<const char*, 2>>({
      {"imu/refused", "imu lines refused: imu.source is not datagram"},
      {"barometer/refused", "baro lines refused: barometer.source is not datagram"},
      {"base_station/refused", "base lines refused"},
      {"wheels/refused", "wheel lines refused: wheel.source is not datagram"},
  });
  for (std::size_t kind = 0; kind < kWords.size(); ++kind) {
    add_count(report, kWords[kind][0], now.refused[kind], before.refused[kind], kWords[kind][1]);
  }
  add_count(report, "input/not_of_this_role", now.not_of_this_role, before.not_of_this_role,
            "IMU, wheel and base samples, which a base station does not use");
  add_count(report, "input/unsigned_base", now.unsigned_base, before.unsigned_base,
            "base lines refused: they carry no signature, and dds.keys_directory is set");
  add_count(report, "input/clock_steps", now.clock_steps, before.clock_steps,
            "times that a sender's clock was set");
  add_count(report, "input/dropped_by_kernel", now.dropped_by_kernel, before.dropped_by_kernel,
            "datagrams dropped by the kernel: the machine is overloaded");
  add_count(report, "input/no_memory", now.samples_without_memory, before.samples_without_memory,
            "samples dropped: no free chunk of shared memory");
}

std::vector<LevelChange> level_changes(const HealthReport& report, LevelChanges& known) {
  std::vector<LevelChange> changes;
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    if (HealthReport::kSummaryName == entry.name) continue;
    auto change = known.note(entry.name, entry.level, entry.message, report.stamp_ns, entry.value);
    if (change) changes.push_back(std::move(*change));
  }
  return changes;
}

void add_refusals(HealthReport& report, const std::vector<std::string>& realtime_refusals) {
  for (std::size_t i = 0; i < realtime_refusals.size(); ++i) {
    add_entry(report, "realtime/" + std::to_string(i + 1), HealthLevel::kWarning, realtime_refusals[i], 0.0);
  }
}

void add_missing_files(HealthReport& report, const std::string& missing) {
  if (missing.empty()) return;
  add_entry(report, "shared_memory", HealthLevel::kError,
            "no program can attach until isobard restarts; poses go on; removed: " + missing, 0.0);
}

void add_library_faults(HealthReport& report, std::uint64_t now, std::uint64_t before) {
  add_count(report, "shared_memory/faults", now, before,
            "faults that the shared-memory library reported and survived");
}

}  // namespace isobar

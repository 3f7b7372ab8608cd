// SPDX-License-Identifier: BSD-3-Clause
// Entries of a health report that robots and base stations share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/deadline.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/sample_thread.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Time without a sample after which a sensor counts as silent [ns]: many periods of each sensor, ten of a lidar at
/// 10 Hz. The limit of a base station comes from its own cadence.
inline constexpr std::int64_t kSensorSilenceNs = 1'000'000'000;

/// Growth of a counter per second; 0 without elapsed time.
[[nodiscard]] double per_second(std::uint64_t now, std::uint64_t before, double elapsed_s);

/// Entry of a counter of faults; none while it is zero, a warning while it grows.
void add_count(ipc::HealthReport& report, const char* name, std::uint64_t now, std::uint64_t before,
               const char* sentence);

/// Entry of the punctuality of a stage; none before its first
/// output. A warning in intervals with a missed deadline.
/// @param what plural of the stage's output, "scans"
void add_deadline(ipc::HealthReport& report, const char* name, const DeadlineStatus& now,
                  const DeadlineStatus& before, const char* what);

/// A sensor's own entry: its rate, or for how long it has been silent.
/// @param last_ns stamp of its newest sample, robot clock; 0: none yet
/// @param silence_ns time without a sample after which it is silent
/// @param where the input that receives it, "UDP port 2368"
void add_stream(ipc::HealthReport& report, const std::string& name, std::int64_t last_ns, std::int64_t now_ns,
                std::int64_t silence_ns, double rate_hz, const std::string& where);

/// Entries of a barometer attached to this machine.
void add_barometer_device(ipc::HealthReport& report, const BarometerSettings& settings,
                          const BarometerThreadStatus& now, const BarometerThreadStatus& before,
                          std::int64_t now_ns, double rate_hz);

/// Entries of samples to which the calibration applied only in part.
/// @param sensor name of the sensor's own entry
void add_calibration(ipc::HealthReport& report, const std::string& sensor, std::uint64_t outside,
                     std::uint64_t outside_before, std::uint64_t without_temperature,
                     std::uint64_t without_temperature_before);

/// Entries of sample datagrams that were refused, by reason.
void add_input(ipc::HealthReport& report, const SampleThreadStatus& now, const SampleThreadStatus& before);

/// Log lines of the entries whose level has changed since the last report, see LevelChanges::note().
[[nodiscard]] std::vector<std::string> level_changes(const ipc::HealthReport& report, LevelChanges& known);

/// One numbered entry for each refusal, since LevelChanges tells entries apart by their names.
void add_refusals(ipc::HealthReport& report, const std::vector<std::string>& realtime_refusals);

/// Entry of the faults that the shared-memory library reported and survived, see ipc::library_fault_count().
void add_library_faults(ipc::HealthReport& report, std::uint64_t now, std::uint64_t before);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Lines of a health report that robots and base stations have in common.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/deadline.hpp"
#include "daemon/inertial_thread.hpp"
#include "daemon/level_changes.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Interval of the health report [ns]; a fault of the barometer is reported at once.
inline constexpr std::int64_t kReportEveryNs = 1'000'000'000;

/// A sensor that should send is silent after this [ns].
inline constexpr std::int64_t kSilenceNs = 1'000'000'000;

[[nodiscard]] double per_second(std::uint64_t now, std::uint64_t before, double elapsed_s);

/// An entry for a count that should be zero; none while it is. A warning while it grows.
void add_count(ipc::HealthReport& report, const char* name, std::uint64_t now, std::uint64_t before,
               const char* sentence);

/// An entry for the punctuality of a stage; none before its first output. A warning while it is late.
/// @param what it makes, "scans"
void add_deadline(ipc::HealthReport& report, const char* name, const DeadlineStatus& now,
                  const DeadlineStatus& before, const char* what);

/// A sensor's own entry: does it send?
/// @param last_ns robot clock, of its newest sample; 0: none yet
/// @param silence_ns after which it is silent
/// @param where it is listened for
void add_stream(ipc::HealthReport& report, const std::string& name, std::int64_t last_ns, std::int64_t now_ns,
                std::int64_t silence_ns, double rate_hz, const std::string& where);

/// The barometer of this machine.
void add_barometer_device(ipc::HealthReport& report, const BarometerSettings& settings,
                          const BarometerThreadStatus& now, const BarometerThreadStatus& before,
                          std::int64_t now_ns, double rate_hz);

/// How often a calibration could not be applied as it was made.
/// @param sensor the name of the sensor's own entry
void add_calibration(ipc::HealthReport& report, const std::string& sensor, std::uint64_t outside,
                     std::uint64_t outside_before, std::uint64_t without_temperature,
                     std::uint64_t without_temperature_before);

/// What was refused of the sample datagrams, and why.
void add_input(ipc::HealthReport& report, const InertialStatus& now, const InertialStatus& before);

/// The entries that are news, for the log. At the first call sensors that are well are news, too.
[[nodiscard]] std::vector<std::string> news(const ipc::HealthReport& report, LevelChanges& changes);

/// Numbered, because news are known by their names.
void add_refusals(ipc::HealthReport& report, const std::vector<std::string>& realtime_refusals);

}  // namespace isobar

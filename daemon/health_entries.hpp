// SPDX-License-Identifier: BSD-3-Clause
// Entries of a health report that robots and base stations share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "core/prior/prior_estimator.hpp"
#include "daemon/deadline.hpp"
#include "daemon/device_thread.hpp"
#include "daemon/level_changes.hpp"
#include "daemon/sample_thread.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Time without a sample after which a sensor counts as silent [ns]: many periods of each sensor, ten of a
/// lidar at 10 Hz. The limit of a base station comes from its own cadence.
inline constexpr std::int64_t kSensorSilenceNs = 1'000'000'000;

/// Time without an output after which what a stage last said is stale [ns]: twenty scans.
inline constexpr std::int64_t kStageSilenceNs = 2'000'000'000;

/// Growth of a counter per second; 0 without elapsed time.
[[nodiscard]] double per_second(std::uint64_t now, std::uint64_t before, double elapsed_s);

/// Entry of a fault counter: absent while the counter is zero; a warning when it has grown since the last
/// report, otherwise ok.
void add_count(ipc::HealthReport& report, const char* name, std::uint64_t now, std::uint64_t before,
               const char* sentence);

/// Punctuality entry of a stage: absent before its first output; stale while there is no output; a warning
/// when a deadline was missed since the last report, otherwise ok.
/// @param what plural of the stage's output, "scans"
/// @param now_ns robot clock
void add_deadline(ipc::HealthReport& report, const char* name, const DeadlineStatus& now,
                  const DeadlineStatus& before, const char* what, std::int64_t now_ns);

/// "no pose for 3 s"; stamps on the robot clock.
[[nodiscard]] std::string silence_text(const char* what, std::int64_t last_ns, std::int64_t now_ns);

/// Main entry of a sensor that the configuration says this robot does not have.
/// @param key of the configuration, "imu.source"
/// @param samples heard of it nevertheless, which are not used
void add_absent(ipc::HealthReport& report, const std::string& name, const char* key, std::uint64_t samples);

/// Main entry of a sensor: its rate, or the duration of its silence.
/// @param last_ns stamp of its newest sample, robot clock; 0: none yet
/// @param silence_ns time without a sample after which it is silent
/// @param where the input that receives it, "UDP port 2368"
/// @param expected false: a robot may lack this sensor, and one that was never heard is ok, as "none"
void add_stream(ipc::HealthReport& report, const std::string& name, std::int64_t last_ns, std::int64_t now_ns,
                std::int64_t silence_ns, double rate_hz, const std::string& where, bool expected = true);

/// Entry of DeviceCounters::corrupt: end of its name, and its sentence.
struct CorruptWords {
  const char* entry;
  const char* sentence;
};
inline constexpr CorruptWords kCorruptMessages{
    "/corrupt", "messages with a wrong checksum, refused: line too long, or another baud rate?"};
inline constexpr CorruptWords kLostEdges{
    "/lost_edges", "edges of encoders lost, at least: is the machine overloaded, does a line bounce?"};

/// Entries of a sensor that this machine reads.
/// @param name of the main entry, "barometer"
/// @param period_ns interval of its samples
void add_device(ipc::HealthReport& report, const std::string& name, std::int64_t period_ns,
                const DeviceThreadStatus& now, const DeviceThreadStatus& before, std::int64_t now_ns,
                double rate_hz, const CorruptWords& corrupt = kCorruptMessages);

/// Counters of the slip of the wheels, see SlipWatch.
void add_slip(ipc::HealthReport& report, const PriorCounters& now, const PriorCounters& before);

/// Interval of the samples of the barometer that barometer.source names, if this machine reads it [ns].
[[nodiscard]] std::int64_t barometer_period_ns(const BarometerSettings& barometer);

/// Counters of the samples outside of the calibrated range and of those without the temperature that the
/// calibration needs.
/// @param sensor name of the sensor's main entry
void add_calibration(ipc::HealthReport& report, const std::string& sensor, std::uint64_t outside,
                     std::uint64_t outside_before, std::uint64_t without_temperature,
                     std::uint64_t without_temperature_before);

/// Counters of refused or dropped sample datagrams, by reason, and of clock steps of their senders.
void add_input(ipc::HealthReport& report, const SampleThreadStatus& now, const SampleThreadStatus& before);

/// Entries whose level has changed since the last report, see LevelChanges::note(); without the summary.
[[nodiscard]] std::vector<LevelChange> level_changes(const ipc::HealthReport& report, LevelChanges& known);

/// One entry for each refused real-time setting, numbered because LevelChanges identifies entries by name.
void add_refusals(ipc::HealthReport& report, const std::vector<std::string>& realtime_refusals);

/// Error while files of shared memory are missing: no program can attach. Absent otherwise.
/// @param missing names, see ipc::check_broker_files()
void add_missing_files(ipc::HealthReport& report, const std::string& missing);

/// Entry of the faults that the shared-memory library reported and survived, see ipc::library_fault_count().
void add_library_faults(ipc::HealthReport& report, std::uint64_t now, std::uint64_t before);

/// Entry of the directions of the pose that the scans leave open, and of who holds them. A warning where nobody does.
void add_localisability(ipc::HealthReport& report, const Localisability& localisability);

}  // namespace isobar

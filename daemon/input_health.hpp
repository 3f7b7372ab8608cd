// SPDX-License-Identifier: BSD-3-Clause
// Health entries of what the inputs hear: senders, addresses that are waited for, the system clock.
#pragma once

#include <cstdint>
#include <string>

#include "core/time/system_clock_watch.hpp"
#include "daemon/device_thread.hpp"
#include "daemon/path_choice.hpp"
#include "daemon/sample_input.hpp"
#include "daemon/start_over.hpp"
#include "drivers/udp/sender_lock.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Time for which a second sender, a change of senders or a step of the system clock is a warning [ns].
inline constexpr std::int64_t kSenderMemoryNs = 10'000'000'000;

/// Adds the entry `name`/senders of a stream: absent while one sender only was heard; a warning while another
/// one sends, or has just taken over.
/// @param remedy what the user can do, such as "lidar.sender chooses"
void add_senders(ipc::HealthReport& report, const std::string& name, const SenderStatus& status,
                 std::int64_t now_ns, const char* remedy);

/// Adds the senders of the sample datagrams, and those that input.senders refuses.
void add_sample_senders(ipc::HealthReport& report, const SampleInputStatus& now,
                        const SampleInputStatus& before, std::int64_t now_ns);

/// Adds the entry `name`/paths: absent while a base station was heard on one path only.
void add_paths(ipc::HealthReport& report, const std::string& name, const PathStatus& status,
               std::int64_t now_ns);

/// Adds the entry "system_clock": how often it was set since the start, and by how much the last time; a
/// warning for kSenderMemoryNs after a step.
void add_system_clock(ipc::HealthReport& report, const SystemClockWatch& system, std::int64_t now_ns);

/// What a sensor that this machine reads waits for, see Graph::waiting_for(); empty: nothing.
[[nodiscard]] std::string waiting_for(const DeviceThreadStatus& sensor);

/// Adds the entry "input/starts_over": absent before the first one; a warning for kSenderMemoryNs.
void add_starts_over(ipc::HealthReport& report, const StartOver& start_over, std::int64_t now_ns);

/// A signed duration: "+3 days 02:00:05", "-0.250 s".
[[nodiscard]] std::string duration_text(std::int64_t duration_ns);

/// The log line of a step of the system clock.
[[nodiscard]] std::string step_text(std::int64_t step_ns);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Entries `session` (the map frame, and why it is not that of the run before), `initial_pose` (what became of the last
/// hint; its value is the number of hints) and `disk` (of the run's files).
void add_run_entries(const StatusSnapshot& now, ipc::HealthReport& report);

/// Says in the log what became of a hint, once it is known.
void log_hint(const StatusSnapshot& now, const StatusSnapshot& before);

}  // namespace isobar

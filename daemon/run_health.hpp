// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/health.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Entries `session` (the map frame, and why it is not that of the run before) and `disk` (of the run's files).
void add_run_entries(const StatusSnapshot& now, ipc::HealthReport& report);

}  // namespace isobar

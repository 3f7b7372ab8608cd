// SPDX-License-Identifier: BSD-3-Clause
// Health of the sensors' clocks and arrivals.
#pragma once

#include <string>

#include "daemon/arrival_meter.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// "offset -3.200 s, latency 0.40 ms (p99 1.90 ms), jitter 0.20 ms"; "no clock of its own" instead of the offset.
[[nodiscard]] std::string timing_text(const ArrivalFigures& figures);

/// Adds the entry `sensor`/timing: stale while the sensor is silent, absent before it was measured.
void add_timing(ipc::HealthReport& report, const std::string& sensor, const ArrivalFigures& figures);

/// Fills offset, latency and jitter.
void fill_timing(const ArrivalFigures& figures, ipc::SensorStatus& sensor);

}  // namespace isobar

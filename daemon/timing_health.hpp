// SPDX-License-Identifier: BSD-3-Clause
// Health of the sensors' clocks and arrivals.
#pragma once

#include <string>

#include "daemon/arrival_meter.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// "offset -3.200 s, latency 0.40 ms (p99 1.90 ms), jitter 0.20 ms"; "no clock of its own" instead of the offset.
[[nodiscard]] std::string timing_text(const ArrivalFigures& figures);

/// Adds the entry `sensor`/timing, never more than information; absent until the sensor was heard.
/// @param heard at any time
void add_timing(ipc::HealthReport& report, const std::string& sensor, bool heard,
                const ArrivalFigures& figures);

/// Fills offset, latency and jitter.
void fill_timing(const ArrivalFigures& figures, ipc::SensorStatus& sensor);

}  // namespace isobar

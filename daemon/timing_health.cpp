// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/timing_health.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "daemon/health_entry.hpp"
#include "daemon/input_health.hpp"

namespace isobar {

std::string timing_text(const ArrivalFigures& figures) {
  const std::string offset = std::isnan(figures.offset_s)
                                 ? "no clock of its own"
                                 : "offset " + duration_text(std::llround(figures.offset_s * 1e9));
  const std::string jitter =
      std::isnan(figures.jitter_ms) ? "" : fmt::format(", jitter {:.2f} ms", figures.jitter_ms);
  return fmt::format("{}, latency {:.2f} ms (p99 {:.2f} ms){}", offset, figures.latency_ms,
                     figures.latency_p99_ms, jitter);
}

void add_timing(ipc::HealthReport& report, const std::string& sensor, const ArrivalFigures& figures) {
  if (!figures.measured) return;
  if (figures.known()) {
    add_entry(report, sensor + "/timing", ipc::HealthLevel::kOk, timing_text(figures), figures.latency_ms);
  } else {
    add_entry(report, sensor + "/timing", ipc::HealthLevel::kStale, "nothing arrives", 0.0);
  }
}

void fill_timing(const ArrivalFigures& figures, ipc::SensorStatus& sensor) {
  sensor.offset_s = figures.offset_s;
  sensor.latency_ms = figures.latency_ms;
  sensor.latency_p99_ms = figures.latency_p99_ms;
  sensor.jitter_ms = figures.jitter_ms;
}

}  // namespace isobar

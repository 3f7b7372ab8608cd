// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "config/config.hpp"
#include "daemon/barometer_thread.hpp"
#include "daemon/sample_thread.hpp"
#include "daemon/station_thread.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Status of all threads of a base station at one moment.
struct StationSnapshot {
  std::int64_t now_ns = 0;  ///< robot clock
  SampleThreadStatus input;
  BarometerThreadStatus barometer;
  StationStatus station;
};

/// Adds the status of a base station to a health report. Rates and growth are relative to the last call. One
/// thread.
class StationMonitor {
 public:
  explicit StationMonitor(const Config& config) : config_(config) {}

  void fill(const StationSnapshot& now, ipc::HealthReport& report);

 private:
  Config config_;
  StationSnapshot before_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "config/config.hpp"
#include "daemon/device_thread.hpp"
#include "daemon/sample_thread.hpp"
#include "daemon/station_thread.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Status of all threads of a base station at one moment.
struct StationSnapshot {
  std::int64_t now_ns = 0;  ///< robot clock
  SampleThreadStatus input;
  DeviceThreadStatus barometer;
  StationStatus station;
  std::string input_waits_for{};  ///< see UdpReceiver::waiting_for()
};

/// Adds the entries of a base station to a health report; rates and growth from `before` to `now`.
/// @param before status at the last report; default-constructed: none yet
void fill_station_health(const StationSnapshot& now, const StationSnapshot& before, const Config& config,
                         ipc::HealthReport& report);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Figures of a run for `isobar status` and `isobar metrics`.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "daemon/health.hpp"
#include "daemon/station_health.hpp"
#include "ipc/status.hpp"

namespace isobar {

/// Times of the stages over the last minute. One thread.
class StageTimes {
 public:
  void add(const char* name, const DeadlineStatus& stage, std::int64_t now_ns, ipc::ServiceStatus& out);

 private:
  static constexpr std::int64_t kWindowNs = 60'000'000'000;
  static constexpr std::int64_t kStepNs = 5'000'000'000;
  struct Reading {
    std::int64_t time_ns = 0;
    LatencyHistogram times;
  };
  std::map<std::string, std::deque<Reading>> readings_;  // of the last minute, one every step
};

/// Sensors, stages, pose, height and map of a robot.
/// @param before status at the last report, for the rates
void fill_robot_figures(const StatusSnapshot& now, const StatusSnapshot& before, StageTimes& times,
                        ipc::ServiceStatus& out);

/// The floor that the robot is on.
void fill_floor(const ipc::CurrentFloor& floor, ipc::FloorFigures& out);

/// The barometer of a base station.
void fill_station_figures(const StationSnapshot& now, const StationSnapshot& before, ipc::ServiceStatus& out);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// What tests of threads that read a device ask of them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>

#include "drivers/device/device.hpp"
#include "ipc/topics.hpp"

namespace isobar::test {

/// An entry of a health report: level and message; "no entry" if there is none of this name.
inline std::pair<ipc::HealthLevel, std::string> entry_of(const ipc::HealthReport& report,
                                                         const std::string& name) {
  for (std::uint32_t i = 0; i < report.entry_count; ++i) {
    if (name == report.entries[i].name) return {report.entries[i].level, report.entries[i].message};
  }
  return {ipc::HealthLevel::kStale, "no entry"};
}

/// Waits until a DeviceThread's device has a state, at most `longest`; the time that it took [ms].
template <class Thread>
double wait_for_state(const Thread& thread, DeviceState state, std::chrono::seconds longest) {
  const auto begin = std::chrono::steady_clock::now();
  while (thread.status().device.state != state && std::chrono::steady_clock::now() - begin < longest) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace isobar::test

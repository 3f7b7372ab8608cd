// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <thread>

namespace isobar::tools {

/// Polls `ready` every 50 ms until it holds or the time is over. For commands that wait for isobard, which reports its
/// health once a second.
/// @return whether it holds
template <class Ready>
bool wait_until(std::chrono::steady_clock::time_point end, const Ready& ready) {
  while (!ready()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

}  // namespace isobar::tools

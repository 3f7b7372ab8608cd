// SPDX-License-Identifier: BSD-3-Clause
// Drives an inertial device on a pseudo-terminal, in real time as the daemon's thread does.
#pragma once

#include <poll.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/clock/robot_clock.hpp"
#include "drivers/device/device.hpp"

namespace isobar::test {

class ImuBench {
 public:
  /// @param sensor the sensor's side, called at least every millisecond
  ImuBench(std::unique_ptr<Device<InertialReading>> tested, std::function<void(std::int64_t)> sensor)
      : device(std::move(tested)), sensor_(std::move(sensor)) {}

  /// Runs until `done` or the time is over; true when done.
  bool run_until(double seconds, const std::function<bool()>& done) {
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (monotonic_ns() < end_ns) {
      sensor_(monotonic_ns());
      pollfd wait{device->file_descriptor(), POLLIN, 0};  // a negative descriptor is ignored
      poll(&wait, 1, 1);
      if (wait.revents != 0 || monotonic_ns() >= next_ns_) {
        const Device<InertialReading>::Step step = device->step(monotonic_ns());
        next_ns_ = step.next_ns;
        if (step.has_sample) samples.push_back(step.sample);
      }
      if (done()) return true;
    }
    return false;
  }
  void run(double seconds) {
    run_until(seconds, [] { return false; });
  }
  bool run_until_state(double seconds, DeviceState state) {
    return run_until(seconds, [&] { return device->status().state == state; });
  }
  [[nodiscard]] std::string fault() const { return device->status().fault.data(); }
  [[nodiscard]] DeviceState state() const { return device->status().state; }

  std::unique_ptr<Device<InertialReading>> device;
  std::vector<InertialReading> samples;

 private:
  std::function<void(std::int64_t)> sensor_;
  std::int64_t next_ns_ = 0;
};

}  // namespace isobar::test

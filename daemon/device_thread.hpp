// SPDX-License-Identifier: BSD-3-Clause
// Threads that read a sensor of this machine (Device<Sample>) and publish its samples.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "daemon/seq_lock.hpp"
#include "daemon/stoppable_timer.hpp"
#include "daemon/worker.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "drivers/device/device.hpp"

namespace isobar {

/// Status of a thread that reads a device.
struct DeviceThreadStatus {
  bool present = false;          ///< false: no such thread, samples come from elsewhere
  std::array<char, 80> place{};  ///< "DPS310 on /dev/i2c-1 at 0x77"
  DeviceStatus device;
  std::uint64_t samples_without_memory = 0;
};

/// Reads a sensor attached to this machine: a step at the time that the device names, or when its descriptor
/// is readable. A missing or failed sensor is retried for ever; nothing else waits for it.
///
/// @tparam Output `bool send(const Sample&) noexcept`, false when there is no free chunk
template <class Sample, class Output>
class DeviceThread {
 public:
  /// @throws ServiceError when the kernel refuses a timer
  template <class... OutputArguments>
  DeviceThread(std::unique_ptr<Device<Sample>> device, ThreadSettings settings, OutputArguments&&... output)
      : device_(std::move(device)),
        output_(std::forward<OutputArguments>(output)...),
        worker_(std::move(settings), timer_, [this] { loop(); }) {
    draft_status_.present = true;
    device_->place().copy(draft_status_.place.data(), draft_status_.place.size() - 1);
    status_.put(draft_status_);
  }

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] DeviceThreadStatus status() const noexcept { return status_.get(); }

 private:
  /// Most samples taken in one round; bounded, so that a device that always has more cannot keep the thread
  /// from its end and the core from threads of lower priority.
  static constexpr int kMaxSamplesARound = 64;

  void loop() noexcept {
    std::int64_t wait_ns = 0;
    do {
      worker_.heartbeat().beat();
      wait_ns = round();
    } while (timer_.sleep_for(wait_ns, device_->file_descriptor()));
  }

  /// @return time until the next step [ns]
  std::int64_t round() noexcept {
    typename Device<Sample>::Step step;
    for (int samples = 0; samples < kMaxSamplesARound; ++samples) {
      step = device_->step(RobotClock::now_ns());
      if (!step.has_sample) break;
      if (!output_.send(step.sample)) ++draft_status_.samples_without_memory;
      if (step.next_ns > RobotClock::now_ns()) break;
    }
    draft_status_.device = device_->status();
    status_.put(draft_status_);
    return step.next_ns - RobotClock::now_ns();
  }

  std::unique_ptr<Device<Sample>> device_;
  StoppableTimer timer_;
  Output output_;
  DeviceThreadStatus draft_status_;
  SeqLock<DeviceThreadStatus> status_;
  Worker worker_;
};

}  // namespace isobar

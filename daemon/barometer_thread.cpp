// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/barometer_thread.hpp"

#include "drivers/clock/robot_clock.hpp"

namespace isobar {

BarometerThread::BarometerThread(std::unique_ptr<Device<PressureSample>> device, ThreadSettings settings)
    : device_(std::move(device)),
      publisher_(ipc::topics::kBarometer),
      worker_(std::move(settings), timer_, [this] { loop(); }) {
  draft_status_.present = true;
  device_->place().copy(draft_status_.place.data(), draft_status_.place.size() - 1);
  status_.put(draft_status_);
}

void BarometerThread::loop() noexcept {
  do {
    worker_.heartbeat().beat();
  } while (timer_.sleep_for(step(), device_->file_descriptor()));
}

/// @return time until the next step [ns]
std::int64_t BarometerThread::step() noexcept {
  const Device<PressureSample>::Step step = device_->step(RobotClock::now_ns());
  if (step.has_sample && !publisher_.send(step.sample)) ++draft_status_.samples_without_memory;
  draft_status_.device = device_->status();
  status_.put(draft_status_);
  return step.next_ns - RobotClock::now_ns();
}

}  // namespace isobar

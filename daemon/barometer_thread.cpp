// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/barometer_thread.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/errors.hpp"
#include "drivers/datagram/udp.hpp"

namespace isobar {

BarometerThread::BarometerThread(std::unique_ptr<BarometerDevice> device, ThreadSettings settings)
    : settings_(std::move(settings)), device_(std::move(device)), publisher_(ipc::topics::kBarometer) {
  timer_ = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  stop_event_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (timer_ < 0 || stop_event_ < 0) {
    const int error = errno;
    close(timer_);
    close(stop_event_);
    throw ServiceError(device_->place() + ": no timer: " + std::strerror(error));
  }
  own_.present = true;
  device_->place().copy(own_.place.data(), own_.place.size() - 1);
  status_.put(own_);
}

BarometerThread::~BarometerThread() {
  stop();
  close(timer_);
  close(stop_event_);
}

void BarometerThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void BarometerThread::stop() noexcept {
  const std::uint64_t one = 1;
  // Fails only when the event is already set many times over: it is set, then.
  [[maybe_unused]] const ssize_t written = write(stop_event_, &one, sizeof one);
  if (thread_.joinable()) thread_.join();
}

void BarometerThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  do {
    heartbeat_.beat();
    arm(step());
  } while (wait());
}

/// Returns how long to wait until the next one [ns].
std::int64_t BarometerThread::step() noexcept {
  const BarometerDevice::Step step = device_->step(RobotClock::now_ns());
  if (step.has_sample && !publisher_.send(step.sample)) ++own_.samples_without_memory;
  own_.device = device_->status();
  status_.put(own_);
  return step.next_ns - RobotClock::now_ns();
}

void BarometerThread::arm(std::int64_t wait_ns) noexcept {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  // A device that took longer than its own period must not keep a core from threads of lower priority.
  constexpr std::int64_t kShortestNs = 500'000;
  wait_ns = std::max(wait_ns, kShortestNs);
  itimerspec when{};
  when.it_value.tv_sec = wait_ns / kNsPerSecond;
  when.it_value.tv_nsec = wait_ns % kNsPerSecond;
  timerfd_settime(timer_, 0, &when, nullptr);
}

/// False when the thread is to end.
bool BarometerThread::wait() noexcept {
  std::array<pollfd, 2> waits{pollfd{timer_, POLLIN, 0}, pollfd{stop_event_, POLLIN, 0}};
  while (poll(waits.data(), waits.size(), -1) < 0 && errno == EINTR) {
  }
  std::uint64_t expirations = 0;
  [[maybe_unused]] const ssize_t length = read(timer_, &expirations, sizeof expirations);
  return waits[1].revents == 0;
}

}  // namespace isobar

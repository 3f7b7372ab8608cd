// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/stoppable_timer.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "core/errors.hpp"

namespace isobar {

StoppableTimer::StoppableTimer()
    : timer_(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)),
      stop_event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!timer_ || !stop_event_) throw ServiceError("the kernel refuses a timer: " + errno_message());
}

bool StoppableTimer::sleep_for(std::int64_t duration_ns, int file_descriptor) noexcept {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  constexpr std::int64_t kShortestNs = 500'000;
  duration_ns = std::max(duration_ns, kShortestNs);
  itimerspec when{};
  when.it_value.tv_sec = duration_ns / kNsPerSecond;
  when.it_value.tv_nsec = duration_ns % kNsPerSecond;
  timerfd_settime(timer_.get(), 0, &when, nullptr);

  // poll() ignores a negative descriptor.
  std::array<pollfd, 3> waits{pollfd{timer_.get(), POLLIN, 0}, pollfd{stop_event_.get(), POLLIN, 0},
                              pollfd{file_descriptor, POLLIN, 0}};
  while (poll(waits.data(), waits.size(), -1) < 0 && errno == EINTR) {
  }
  std::uint64_t expirations = 0;
  [[maybe_unused]] const ssize_t length = read(timer_.get(), &expirations, sizeof expirations);
  return waits[1].revents == 0;
}

void StoppableTimer::stop() noexcept {
  const std::uint64_t one = 1;
  // Fails only when the counter is full, that is, when the event is already set.
  [[maybe_unused]] const ssize_t written = write(stop_event_.get(), &one, sizeof one);
}

}  // namespace isobar

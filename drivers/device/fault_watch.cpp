// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/device/fault_watch.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace isobar {

void FaultWatch::starts(std::int64_t now_ns) noexcept {
  ++status_.counters.starts;
  newest_good_ns_ = now_ns;
  good_since_ns_ = 0;
  problem_ = nullptr;
}

void FaultWatch::expects_results(std::int64_t now_ns) noexcept {
  newest_good_ns_ = now_ns;
  problem_ = nullptr;
}

void FaultWatch::good(std::int64_t now_ns) noexcept {
  newest_good_ns_ = now_ns;
  if (good_since_ns_ == 0) good_since_ns_ = now_ns;
  if (now_ns - good_since_ns_ >= kWellNs) wait_ns_ = kFirstWaitNs;
  problem_ = nullptr;
  status_.state = DeviceState::kMeasuring;
  status_.fault[0] = '\0';
  status_.last_sample_ns = now_ns;
  ++status_.counters.samples;
}

void FaultWatch::problem(DeviceState state, const char* what, int error) noexcept {
  problem_state_ = state;
  problem_ = what;
  problem_error_ = error;
}

std::int64_t FaultWatch::fail(DeviceState state, const char* what, std::int64_t now_ns, int error) noexcept {
  set_fault(state, what, error);
  const std::int64_t next_ns = now_ns + wait_ns_;
  wait_ns_ = std::min(2 * wait_ns_, longest_wait_ns_);
  return next_ns;
}

std::int64_t FaultWatch::give_up(std::int64_t now_ns) noexcept {
  ++status_.counters.silent;
  if (problem_ == nullptr) return fail(DeviceState::kSilent, "no new result", now_ns);
  return fail(problem_state_, problem_, now_ns, problem_error_);
}

void FaultWatch::note(const char* what) noexcept {
  std::snprintf(status_.note.data(), status_.note.size(), "%s", what != nullptr ? what : "");
}

void FaultWatch::set_fault(DeviceState state, const char* what, int error) noexcept {
  status_.state = state;
  if (error == 0) {
    std::snprintf(status_.fault.data(), status_.fault.size(), "%s", what);
  } else {
    // strerrordesc_np: thread-safe, unlike strerror.
    const char* words = strerrordesc_np(error);
    std::snprintf(status_.fault.data(), status_.fault.size(), "%s (%s)", what,
                  words != nullptr ? words : "unknown error");
  }
}

}  // namespace isobar

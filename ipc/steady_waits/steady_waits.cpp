// SPDX-License-Identifier: BSD-3-Clause
// Timed waits of libraries on CLOCK_MONOTONIC, in every program that links this file: the two functions take the place
// of libc's, also for shared libraries, because the program comes first in the order of symbols.
//
// iceoryx 2.0.3 (sem_timedwait) and Cyclone DDS 0.10.2 (pthread_cond_timedwait) wait until a time of CLOCK_REALTIME.
// Where that clock is set back by three days, their threads for discovery slept for three days: no new subscriber of
// DDS heard of the bridge, and no shared memory of a process that had ended was freed.
#include <pthread.h>
#include <semaphore.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;
/// Longest wait [s]; keeps the sums below inside 64 bits.
constexpr std::int64_t kMostS = 1'000'000'000;

timespec now_on(clockid_t clock) noexcept {
  timespec now{};
  static_cast<void>(::clock_gettime(clock, &now));
  return now;
}

/// The moment `until` of the system clock on CLOCK_MONOTONIC. Unchanged: an invalid one, which the wait refuses, and one
/// that is nearer to CLOCK_MONOTONIC, of a condition variable with that clock as its attribute.
timespec on_monotonic_clock(const timespec& until) noexcept {
  const timespec system = now_on(CLOCK_REALTIME);
  const timespec monotonic = now_on(CLOCK_MONOTONIC);
  const std::int64_t until_s = std::clamp<std::int64_t>(until.tv_sec, -kMostS, system.tv_sec + kMostS);
  if (until.tv_nsec < 0 || until.tv_nsec >= kNsPerS) return until;
  if (std::abs(until_s - monotonic.tv_sec) < std::abs(until_s - system.tv_sec)) return until;
  const std::int64_t left_ns = (until_s - system.tv_sec) * kNsPerS + until.tv_nsec - system.tv_nsec;
  const std::int64_t end_ns =
      monotonic.tv_sec * kNsPerS + monotonic.tv_nsec + std::max<std::int64_t>(0, left_ns);
  return {end_ns / kNsPerS, end_ns % kNsPerS};
}

}  // namespace

extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* until) {
  const timespec end = on_monotonic_clock(*until);
  return ::pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &end);
}

extern "C" int sem_timedwait(sem_t* semaphore, const timespec* until) {
  const timespec end = on_monotonic_clock(*until);
  return ::sem_clockwait(semaphore, CLOCK_MONOTONIC, &end);
}

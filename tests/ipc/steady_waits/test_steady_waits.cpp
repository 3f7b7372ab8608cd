// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <thread>

namespace isobar::test::test_steady_waits {

namespace {

timespec after_ms(clockid_t clock, long milliseconds) {
  timespec moment{};
  ::clock_gettime(clock, &moment);
  const long ns = moment.tv_nsec + milliseconds * 1'000'000;
  return {moment.tv_sec + ns / 1'000'000'000, ns % 1'000'000'000};
}

/// Operation of the futex that a thread waits in while `wait` runs; 0: none.
unsigned long futex_operation_of(const std::function<void()>& wait) {
  std::atomic<pid_t> id{0};
  std::thread waiting([&] {
    id = ::gettid();
    wait();
  });
  unsigned long operation = 0;
  for (int i = 0; i < 100 && operation == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::ifstream file("/proc/self/task/" + std::to_string(id) + "/syscall");
    long number = 0;
    std::string address;
    if (file >> number && number == SYS_futex) {
      file >> address >> std::hex >> operation;
    }
  }
  waiting.join();
  return operation;
}

/// FUTEX_CLOCK_REALTIME of linux/futex.h: the wait ends at a time of the system clock.
constexpr unsigned long kUntilSystemTime = 256;

struct Condition {
  pthread_cond_t condition;
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

  explicit Condition(clockid_t clock) {
    pthread_condattr_t attributes;
    ::pthread_condattr_init(&attributes);
    ::pthread_condattr_setclock(&attributes, clock);
    ::pthread_cond_init(&condition, &attributes);
    ::pthread_condattr_destroy(&attributes);
  }
  int wait_until(const timespec& until) {
    ::pthread_mutex_lock(&mutex);
    const int result = ::pthread_cond_timedwait(&condition, &mutex, &until);
    ::pthread_mutex_unlock(&mutex);
    return result;
  }
};

TEST_CASE("waits until a time of the system clock are on the monotonic clock, and end after the same time") {
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC}) {
    Condition condition(clock);
    const auto began = std::chrono::steady_clock::now();
    int result = 0;
    const unsigned long operation =
        futex_operation_of([&] { result = condition.wait_until(after_ms(clock, 300)); });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    CHECK(operation != 0);
    CHECK((operation & kUntilSystemTime) == 0);
    CHECK(result == ETIMEDOUT);
    CHECK(seconds > 0.29);
    CHECK(seconds < 5.0);
  }
  sem_t semaphore;
  REQUIRE(::sem_init(&semaphore, 0, 0) == 0);
  int result = 0;
  const unsigned long operation = futex_operation_of([&] {
    const timespec until = after_ms(CLOCK_REALTIME, 300);
    result = ::sem_timedwait(&semaphore, &until) == 0 ? 0 : errno;
  });
  CHECK(operation != 0);
  CHECK((operation & kUntilSystemTime) == 0);
  CHECK(result == ETIMEDOUT);
}

TEST_CASE("waits that a moment in the past, an invalid one or a distant one ends at once, or a signal") {
  Condition condition(CLOCK_REALTIME);
  CHECK(condition.wait_until({0, 0}) == ETIMEDOUT);
  CHECK(condition.wait_until({-5, 0}) == ETIMEDOUT);
  CHECK(condition.wait_until({0, 2'000'000'000}) == EINVAL);
  sem_t semaphore;
  REQUIRE(::sem_init(&semaphore, 0, 1) == 0);
  const timespec distant{std::numeric_limits<time_t>::max(), 0};
  CHECK(::sem_timedwait(&semaphore, &distant) == 0);
  std::thread post([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::sem_post(&semaphore);
  });
  CHECK(::sem_timedwait(&semaphore, &distant) == 0);
  post.join();
}

}  // namespace

}  // namespace isobar::test::test_steady_waits

// SPDX-License-Identifier: BSD-3-Clause
// Wake-up latency: from send() in one thread to the return of wait() in another, through a queue in shared
// memory.
#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "ipc/shared_memory.hpp"
#include "tests/benchmark/micro/percentiles.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)
using Clock = std::chrono::steady_clock;

constexpr ipc::Topic<ImuSample> kTopic{"benchmark/wake_up", 16, 0};

/// Thread that records its wake-up times.
class Sleeper {
 public:
  Sleeper() : samples_(kTopic), waiter_({&samples_.raw()}), thread_([this] { loop(); }) {}
  ~Sleeper() {
    waiter_.stop();
    thread_.join();
  }
  Sleeper(const Sleeper&) = delete;
  Sleeper& operator=(const Sleeper&) = delete;

  /// Waits for wake-up number `count`.
  [[nodiscard]] Clock::time_point woken(std::uint64_t count) const {
    for (std::uint64_t seen = count_.load(); seen < count; seen = count_.load()) count_.wait(seen);
    return woken_;
  }

 private:
  void loop() {
    while (waiter_.wait() != ipc::Waiter::Event::kStopped) {
      const Clock::time_point now = Clock::now();
      bool taken = false;
      while (samples_.take()) taken = true;
      if (!taken) continue;
      woken_ = now;
      ++count_;
      count_.notify_one();
    }
  }

  ipc::Subscriber<ImuSample> samples_;
  ipc::Waiter waiter_;
  Clock::time_point woken_;
  std::atomic<std::uint64_t> count_{0};
  std::thread thread_;
};

void wake_up(benchmark::State& state) {
  const ipc::Broker broker;
  ipc::Publisher<ImuSample> publisher(kTopic);
  const Sleeper sleeper;
  std::vector<double> waits_us;
  for (auto _ : state) {
    // The other thread must be asleep, as between two samples.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Clock::time_point sent = Clock::now();
    publisher.send({});
    const std::chrono::duration<double> wait = sleeper.woken(waits_us.size() + 1) - sent;
    state.SetIterationTime(wait.count());
    waits_us.push_back(wait.count() * 1e6);
  }
  bench::count_percentiles(state, waits_us, "us");
}

BENCHMARK(wake_up)->UseManualTime()->Iterations(2000)->Unit(benchmark::kMicrosecond);

}  // namespace

// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker_watch.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <string>
#include <thread>

#include "drivers/datagram/udp.hpp"

namespace isobar::test::test_worker_watch {

namespace {

/// A worker as those of the pipeline are: asleep until somebody knocks, one heartbeat a round.
class SleepingWorker {
 public:
  SleepingWorker() : thread_([this] { loop(); }) {}
  ~SleepingWorker() {
    ending_ = true;
    hanging_ = false;
    hanging_.notify_all();
    knock();
    thread_.join();
  }
  SleepingWorker(const SleepingWorker&) = delete;
  SleepingWorker& operator=(const SleepingWorker&) = delete;

  [[nodiscard]] const Heartbeat& heartbeat() const { return heartbeat_; }
  void knock() {
    knocks_.fetch_add(1);
    knocks_.notify_all();
  }
  void hang() { hanging_ = true; }

 private:
  void loop() {
    for (int seen = 0; !ending_;) {
      knocks_.wait(seen);
      hanging_.wait(true);
      seen = knocks_.load();
      heartbeat_.beat();
    }
  }
  Heartbeat heartbeat_;
  std::atomic<int> knocks_{0};
  std::atomic<bool> hanging_{false};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// One that wakes by itself, so that there is nothing to knock at.
struct PollingWorker {
  [[nodiscard]] const Heartbeat& heartbeat() const { return beats; }
  Heartbeat beats;
};

std::string threads_entry(const WorkerWatch& watch, ipc::HealthLevel level) {
  ipc::HealthReport report;
  report.entry_count = 0;
  watch.fill(report);
  REQUIRE(report.entry_count == 1);
  CHECK(std::string(report.entries[0].name) == "threads");
  CHECK(report.entries[0].level == level);
  return report.entries[0].message;
}

/// Waits until the worker has answered a knock that came after `since_ns`; the test's time limit ends it
/// else.
void wait_for_answer(const SleepingWorker& worker, std::int64_t since_ns) {
  while (worker.heartbeat().last_ns() <= since_ns) std::this_thread::yield();
}

}  // namespace

TEST_CASE("a worker without any work is alive for as long as it answers, however late it is looked at") {
  SleepingWorker worker;
  WorkerWatch watch;
  watch.add("map", worker);
  std::int64_t knocked_ns = RobotClock::now_ns();
  CHECK(watch.all_alive(knocked_ns));
  for (int second = 0; second < 3; ++second) {
    wait_for_answer(worker, knocked_ns);
    knocked_ns = RobotClock::now_ns();
    CHECK(watch.all_alive(worker.heartbeat().last_ns() + WorkerWatch::kSilenceNs));
  }
  CHECK(threads_entry(watch, ipc::HealthLevel::kOk) == "all answer");
}

TEST_CASE("one worker that hangs is enough: it is named, and once it goes on all are alive again") {
  SleepingWorker hanging;
  PollingWorker well;
  WorkerWatch watch;
  watch.add("map", hanging);
  watch.add("lidar", well);
  hanging.hang();
  const std::int64_t last_ns = hanging.heartbeat().last_ns();
  well.beats.beat();
  CHECK(watch.all_alive(last_ns + WorkerWatch::kSilenceNs));

  // Six seconds later, as far as the watch is told. The other worker has left signs of life meanwhile.
  const std::int64_t later_ns = last_ns + WorkerWatch::kSilenceNs + 1'000'000'000;
  well.beats.beat_at(later_ns);
  CHECK_FALSE(watch.all_alive(later_ns));
  const std::string said = threads_entry(watch, ipc::HealthLevel::kError);
  CHECK(said.find("map for 6 s") != std::string::npos);
  CHECK(said.find("lidar") == std::string::npos);
}

TEST_CASE("a worker that never starts has as long as any other, and is then found") {
  PollingWorker never_started;
  WorkerWatch watch;
  watch.add("registration", never_started);
  CHECK(watch.all_alive(never_started.beats.last_ns() + WorkerWatch::kSilenceNs));
  CHECK_FALSE(watch.all_alive(never_started.beats.last_ns() + WorkerWatch::kSilenceNs + 1));
}

}  // namespace isobar::test::test_worker_watch

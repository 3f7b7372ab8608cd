// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/worker_group.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "drivers/clock/robot_clock.hpp"

namespace isobar::test::test_worker_group {

namespace {

/// Wait object of a stage, like ipc::Waiter: waits without a time limit until woken or stopped.
class WaitSource {
 public:
  void wake() {
    wakes_.fetch_add(1);
    wakes_.notify_all();
  }
  void stop() {
    stopped_ = true;
    wake();
  }
  /// False once stopped.
  bool wait(int& seen) {
    wakes_.wait(seen);
    seen = wakes_.load();
    return !stopped_;
  }

 private:
  std::atomic<int> wakes_{0};
  std::atomic<bool> stopped_{false};
};

/// A stage that does nothing but its heartbeat. Its loop can be made to hang, and it records its end.
class IdleStage {
 public:
  explicit IdleStage(const char* name, std::vector<std::string>* ended = nullptr)
      : ended_(ended), worker_({name}, source_, [this] { loop(); }) {}
  ~IdleStage() { release(); }

  Worker& worker() { return worker_; }
  void hang() { hanging_ = true; }
  void release() {
    hanging_ = false;
    hanging_.notify_all();
  }

 private:
  void loop() noexcept {
    for (int seen = 0; source_.wait(seen);) {
      hanging_.wait(true);
      worker_.heartbeat().beat();
    }
    if (ended_ != nullptr) ended_->push_back(worker_.settings().name);
  }
  WaitSource source_;
  std::atomic<bool> hanging_{false};
  std::vector<std::string>* ended_;
  Worker worker_;
};

/// Wait object of a socket's loop. The loop has a timeout of its own and needs no wake().
struct PollingSource {
  void stop() {}
};

std::string threads_entry(const WorkerGroup& group, ipc::HealthLevel level) {
  ipc::HealthReport report;
  group.fill(report);
  REQUIRE(report.entry_count == 1);
  CHECK(std::string(report.entries[0].name) == "threads");
  CHECK(report.entries[0].level == level);
  return report.entries[0].message;
}

/// Waits for a heartbeat after `since_ns`, without a limit: a missing one runs into CTest's timeout.
void wait_for_beat(Worker& worker, std::int64_t since_ns) {
  while (worker.heartbeat().last_ns() <= since_ns) std::this_thread::yield();
}

}  // namespace

TEST_CASE("an idle worker stays alive as long as it beats when it is woken") {
  IdleStage stage("map");
  WorkerGroup group;
  group.add(stage.worker());
  group.start();
  std::int64_t checked_ns = RobotClock::now_ns();
  CHECK(group.all_alive(checked_ns));
  for (int second = 0; second < 3; ++second) {
    wait_for_beat(stage.worker(), checked_ns);
    checked_ns = RobotClock::now_ns();
    CHECK(group.all_alive(stage.worker().heartbeat().last_ns() + WorkerGroup::kSilenceNs));
  }
  CHECK(threads_entry(group, ipc::HealthLevel::kOk) == "all threads run");
}

TEST_CASE("one hung worker fails the check and is named; an unwatched worker may hang") {
  IdleStage hanging("map");
  IdleStage unwatched("barometer");
  PollingSource source;
  Worker polling({"lidar"}, source, [] {});
  WorkerGroup group;
  group.add(hanging.worker());
  group.add(unwatched.worker(), Watch::kNo);
  group.add(polling);
  group.start();
  hanging.hang();
  const std::int64_t last_ns = hanging.worker().heartbeat().last_ns();
  polling.heartbeat().beat();
  CHECK(group.all_alive(last_ns + WorkerGroup::kSilenceNs));

  // Six seconds later on the clock passed to the group; the polling worker had its heartbeat in between.
  const std::int64_t later_ns = last_ns + WorkerGroup::kSilenceNs + 1'000'000'000;
  polling.heartbeat().beat_at(later_ns);
  CHECK_FALSE(group.all_alive(later_ns));
  const std::string message = threads_entry(group, ipc::HealthLevel::kError);
  CHECK(message.find("map for 6 s") != std::string::npos);
  CHECK(message.find("lidar") == std::string::npos);
  CHECK(message.find("barometer") == std::string::npos);
  hanging.release();
}

TEST_CASE("a worker that never starts counts as hung after the same time as any other") {
  IdleStage never_started("registration");
  WorkerGroup group;
  group.add(never_started.worker());
  const std::int64_t built_ns = never_started.worker().heartbeat().last_ns();
  CHECK(group.all_alive(built_ns + WorkerGroup::kSilenceNs));
  CHECK_FALSE(group.all_alive(built_ns + WorkerGroup::kSilenceNs + 1));
}

TEST_CASE(
    "workers stop in the reverse of their start order, each joined before the next; a second stop is "
    "ignored") {
  std::vector<std::string> ended;  // written by one thread at a time, since each is joined before the next
  IdleStage consumer("map", &ended);
  IdleStage middle("registration", &ended);
  IdleStage producer("lidar", &ended);
  WorkerGroup group;
  for (IdleStage* stage : {&consumer, &middle, &producer}) group.add(stage->worker());
  group.start();
  group.stop();
  group.stop();
  CHECK(ended == std::vector<std::string>{"lidar", "registration", "map"});
}

}  // namespace isobar::test::test_worker_group

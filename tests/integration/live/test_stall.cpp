// SPDX-License-Identifier: BSD-3-Clause
// isobard with threads that are stopped for a while: poses resume with the newest scan, and every dropped
// scan is counted.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/clock/robot_clock.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/integration/live/stopped_thread.hpp"
#include "tests/integration/live/tap.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_stall {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::check_steady;
using test::ChildProcess;
using test::Drive;
using test::Pose;
using test::StoppedThread;
using test::Tap;

constexpr std::int64_t kMs = 1'000'000;

const Drive& drive() {
  static const Drive once("stall");
  return once;
}

/// Receiving socket of the watchdog, in place of the service manager.
class Manager {
 public:
  Manager() {
    const std::string path = std::filesystem::temp_directory_path() / "stall-notify";
    std::filesystem::remove(path);
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    thread_ = std::thread([this] { listen(); });
  }
  ~Manager() {
    ::shutdown(socket_, SHUT_RD);
    thread_.join();
    ::close(socket_);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;
  /// Number of watchdog feeds since the last call.
  int feeds() { return feeds_.exchange(0); }

 private:
  // At all times: a full socket would block isobard.
  void listen() {
    std::array<char, 512> message{};
    for (ssize_t length = 0; (length = ::recv(socket_, message.data(), message.size(), 0)) > 0;) {
      const std::string text(message.data(), static_cast<std::size_t>(length));
      feeds_ += text.find("WATCHDOG=1") != std::string::npos ? 1 : 0;
    }
  }
  std::atomic<int> feeds_{0};
  int socket_ = -1;
  std::thread thread_;
};

/// Every scan has one pose at its end; a scan that the registration never received, at its interpolated end.
void check_one_pose_a_scan(const Tap& tap) {
  constexpr std::int64_t kRevolutionJitterNs = 5 * kMs;
  REQUIRE(!tap.poses.empty());
  for (const std::int64_t end_ns : tap.scan_ends_ns) {
    if (end_ns > tap.poses.back().estimate.stamp_ns) continue;  // not yet registered
    int found = 0;
    for (const Pose& pose : tap.poses) {
      found += std::abs(pose.estimate.stamp_ns - end_ns) <= kRevolutionJitterNs ? 1 : 0;
    }
    CHECK(found == 1);
  }
}

/// The first registered pose that was received after `received_after_ns` and whose scan ended after
/// `ended_after_ns`; null without one.
const Pose* first_registered(const std::vector<Pose>& poses, std::int64_t received_after_ns,
                             std::int64_t ended_after_ns) {
  for (const Pose& pose : poses) {
    if (pose.received_ns > received_after_ns && pose.estimate.stamp_ns > ended_after_ns &&
        pose.estimate.mode == PoseMode::kRegistered) {
      return &pose;
    }
  }
  return nullptr;
}

void held_registration(const ChildProcess& isobard, Tap& tap) {
  tap.forget();
  tap.gather(500ms);
  std::int64_t held_ns = 0;
  {
    const StoppedThread held(isobard.pid(), "registration");
    held_ns = RobotClock::now_ns();
    tap.gather(800ms);  // eight scans, of which the queue holds four
  }
  const std::int64_t resumed_ns = RobotClock::now_ns();
  tap.gather(2500ms);
  // The scan that was being registered at the stop is finished first; it ended before held_ns.
  const Pose* first = first_registered(tap.poses, resumed_ns, held_ns);
  REQUIRE(first != nullptr);
  // The newest waiting scan: at most one revolution (100 ms) old, plus what a loaded machine adds.
  CHECK(first->estimate.stamp_ns > resumed_ns - 150 * kMs);
  int from_prior_in_hold = 0;
  for (const Pose& pose : tap.poses) {
    const bool in_hold =
        pose.estimate.stamp_ns > held_ns && pose.estimate.stamp_ns < first->estimate.stamp_ns;
    if (in_hold) CHECK(pose.estimate.mode == PoseMode::kPriorOnly);
    from_prior_in_hold += in_hold ? 1 : 0;
  }
  CHECK(from_prior_in_hold >= 5);
  check_one_pose_a_scan(tap);
  check_steady(tap.poses, 0.1);
  REQUIRE(tap.entry("registration/dropped") != nullptr);
  // Larger if a loaded machine dropped scans before or after the stop as well.
  CHECK(tap.entry("registration/dropped")->value >= from_prior_in_hold);
  REQUIRE(tap.entry("registration/deadline") != nullptr);
  CHECK(tap.entry("registration/deadline")->value >= from_prior_in_hold);
}

void held_process(const ChildProcess& isobard, Tap& tap) {
  tap.forget();
  isobard.signal(SIGSTOP);
  std::this_thread::sleep_for(2s);
  isobard.signal(SIGCONT);
  const std::int64_t resumed_ns = RobotClock::now_ns();
  tap.gather(3s);
  const Pose* fresh = nullptr;
  for (const Pose& pose : tap.poses) {
    if (fresh == nullptr && pose.estimate.stamp_ns > resumed_ns) fresh = &pose;
  }
  REQUIRE(fresh != nullptr);
  // Twenty scans waited. A machine that is too slow to register them all at once drops most of them instead.
  // Measured under a sanitizer: 5 registered, and 0.6 to 1.3 s until the fresh pose.
  int registered_late = 0;
  for (const Pose& pose : tap.poses) {
    const bool waited = pose.estimate.stamp_ns < resumed_ns;
    registered_late += waited && pose.estimate.mode == PoseMode::kRegistered ? 1 : 0;
  }
  const bool is_fast = fresh->received_ns < resumed_ns + 1000 * kMs;
  CHECK((is_fast || registered_late <= 10));
  // Most IMU samples of these two seconds are lost: the prior is accurate to a metre, as in test_live.sh.
  check_steady(tap.poses, 1.0);
  CHECK(first_registered(tap.poses, resumed_ns, resumed_ns) != nullptr);
}

void hung_map(const ChildProcess& isobard, Tap& tap, Manager& manager) {
  static_cast<void>(manager.feeds());
  tap.gather(3s);
  CHECK(manager.feeds() >= 2);
  {
    const StoppedThread held(isobard.pid(), "map");
    tap.gather(7s);  // WorkerGroup::kSilenceNs (5 s) and a report
    static_cast<void>(manager.feeds());
    tap.gather(3s);
    CHECK(manager.feeds() == 0);
    REQUIRE(tap.entry("threads") != nullptr);
    CHECK(tap.entry("threads")->level == ipc::HealthLevel::kError);
    CHECK(std::string(tap.entry("threads")->message).find("map for") != std::string::npos);
  }
  tap.gather(3s);
  CHECK(manager.feeds() >= 1);
  CHECK(tap.entry("threads")->level == ipc::HealthLevel::kOk);
}

}  // namespace

TEST_CASE(
    "after a stopped thread the newest scan is registered first, dropped scans get poses from the prior, and "
    "a "
    "hung thread starves the watchdog") {
  Manager manager;
  ChildProcess isobard({ISOBAR_DAEMON, "--config", drive().config});
  REQUIRE(isobard.read_until("ready:", 20s));
  std::optional<Tap> tap(std::in_place);
  // Without data all threads stay alive, for longer than the limit of a hung one.
  tap->gather(7s);
  CHECK(manager.feeds() >= 5);
  hung_map(isobard, *tap, manager);

  ChildProcess play({ISOBAR_PROGRAM, "play", drive().recording});
  tap->gather(3s);
  // On a loaded machine the bootstrap drops scans and takes longer.
  for (int i = 0; i < 8 && first_registered(tap->poses, 0, 0) == nullptr; ++i) tap->gather(1s);
  tap->gather(1s);
  held_registration(isobard, *tap);
  held_process(isobard, *tap);
  tap.reset();  // an attachment must not outlive isobard
  isobard.signal(SIGTERM);
  CHECK(isobard.wait(20s) == 0);
}

}  // namespace isobar::test::test_stall

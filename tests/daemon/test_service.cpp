// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service.hpp"

#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigtimedwait is POSIX
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <vector>

#include "tests/support/notify_socket.hpp"

namespace isobar::test::test_service {

namespace {

/// Clears pending signals of the service in this process and unblocks them.
void clear_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGHUP);
  const timespec now{};
  while (sigtimedwait(&set, nullptr, &now) > 0) {
  }
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace

TEST_CASE("SIGHUP asks for one reload and does not stop; a reload is told with its time") {
  using namespace std::chrono_literals;
  NotifySocket manager;
  {
    Service service;
    CHECK_FALSE(service.take_reload_request());
    ::kill(::getpid(), SIGHUP);
    CHECK(service.wait_for(0ms));
    CHECK(service.take_reload_request());
    CHECK_FALSE(service.take_reload_request());
    service.reloading();
  }
  clear_signals();
  const auto messages = manager.messages();
  REQUIRE(messages.size() == 1);
  CHECK(messages[0].starts_with("RELOADING=1\nMONOTONIC_USEC="));
}

TEST_CASE("a log that nobody reads ends no program: the write fails") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  {
    const Service service;
    ::close(ends[0]);
    CHECK(::write(ends[1], "x", 1) == -1);
    CHECK(errno == EPIPE);
  }
  ::close(ends[1]);
  clear_signals();
}

TEST_CASE("the supervise loop feeds the watchdog only in ticks with all threads alive, and ends on SIGTERM") {
  using namespace std::chrono_literals;
  NotifySocket manager;
  {
    Service service;
    service.ready("up");
    int ticks = 0;
    service.supervise(
        [&] {
          if (++ticks == 4) ::kill(::getpid(), SIGTERM);
          return ticks % 2 == 0;
        },
        1ms);
    CHECK(ticks == 4);
    CHECK_FALSE(service.wait_for(0ms));  // the stop signal is remembered
  }
  clear_signals();
  CHECK(manager.messages() ==
        std::vector<std::string>{"READY=1\nSTATUS=up", "WATCHDOG=1", "WATCHDOG=1", "STOPPING=1"});
}

}  // namespace isobar::test::test_service

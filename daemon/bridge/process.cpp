// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/process.hpp"

#include <linux/close_range.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigaction is POSIX
#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace isobar::bridge {
namespace {

std::array<char, PATH_MAX> g_program{};
char** g_arguments = nullptr;
std::atomic<void (*)() noexcept> g_time_limit_action{nullptr};

}  // namespace

void remember_arguments(char** argv) {
  g_arguments = argv;
  // The path, not /proc/self/exe itself: after an upgrade the path names the new program.
  const ssize_t length = ::readlink("/proc/self/exe", g_program.data(), g_program.size() - 1);
  if (length > 0) {
    g_program[static_cast<std::size_t>(length)] = '\0';
  }
}

void replace_process() noexcept {
  ::alarm(0);  // a pending alarm survives exec and would end the new program
  // The handler of SIGALRM runs with SIGALRM blocked, and exec keeps the signal mask.
  sigset_t alarm;
  sigemptyset(&alarm);
  sigaddset(&alarm, SIGALRM);
  pthread_sigmask(SIG_UNBLOCK, &alarm, nullptr);
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  if (g_arguments != nullptr) {
    ::execv(g_program.data(), g_arguments);
    ::execv("/proc/self/exe", g_arguments);  // the program's file was removed
  }
  std::_Exit(69);  // EX_UNAVAILABLE
}

void replace_process_later() noexcept {
  const timespec second{1, 0};
  ::nanosleep(&second, nullptr);
  replace_process();
}

void set_time_limit(std::chrono::seconds limit, void (*action)() noexcept) {
  g_time_limit_action.store(action);
  struct sigaction on_alarm {};
  on_alarm.sa_handler = [](int) { g_time_limit_action.load()(); };
  ::sigaction(SIGALRM, &on_alarm, nullptr);
  ::alarm(static_cast<unsigned>(limit.count()));
}

void clear_time_limit() noexcept { ::alarm(0); }

void end_process() noexcept {
  constexpr std::string_view kReason = "isobar-dds: isobard does not answer; ended without detaching\n";
  static_cast<void>(::write(STDERR_FILENO, kReason.data(), kReason.size()) > 0);
  std::_Exit(0);
}

}  // namespace isobar::bridge

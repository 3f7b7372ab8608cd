// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/process.hpp"

#include <linux/close_range.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigtimedwait is POSIX
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <algorithm>
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
std::atomic<void (*)() noexcept> g_time_is_up{nullptr};

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  return set;
}

}  // namespace

StopSignals::StopSignals() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

bool StopSignals::wait_for(std::chrono::milliseconds timeout) {
  const sigset_t set = stop_signals();
  const timespec limit{timeout.count() / 1000, (timeout.count() % 1000) * 1'000'000};
  stopped_ = stopped_ || sigtimedwait(&set, nullptr, &limit) > 0;
  return stopped_;
}

void remember_arguments(char** argv) {
  g_arguments = argv;
  // By name and not by /proc/self/exe itself, so that after an update the new program is started.
  const ssize_t length = ::readlink("/proc/self/exe", g_program.data(), g_program.size() - 1);
  if (length > 0) {
    g_program[static_cast<std::size_t>(length)] = '\0';
  }
}

void replace_process() noexcept {
  ::alarm(0);  // it would outlive the exec, and end the new program
  // Called by a time limit, this runs in the handler of a signal that the new program would never get again.
  sigset_t alarm;
  sigemptyset(&alarm);
  sigaddset(&alarm, SIGALRM);
  pthread_sigmask(SIG_UNBLOCK, &alarm, nullptr);
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  if (g_arguments != nullptr) {
    ::execv(g_program.data(), g_arguments);
    ::execv("/proc/self/exe", g_arguments);
  }
  std::_Exit(69);
}

void replace_process_later() noexcept {
  const timespec second{1, 0};
  ::nanosleep(&second, nullptr);
  replace_process();
}

void limit_time(std::chrono::seconds limit, void (*action)() noexcept) {
  g_time_is_up.store(action);
  struct sigaction on_alarm {};
  on_alarm.sa_handler = [](int) { g_time_is_up.load()(); };
  ::sigaction(SIGALRM, &on_alarm, nullptr);
  ::alarm(static_cast<unsigned>(limit.count()));
}

void lift_time_limit() noexcept { ::alarm(0); }

void end_process() noexcept {
  constexpr std::string_view kWhy = "isobar-dds: isobard does not answer; ended without its farewell\n";
  static_cast<void>(::write(STDERR_FILENO, kWhy.data(), kWhy.size()) > 0);
  std::_Exit(0);
}

ServiceManager::ServiceManager() {
  std::uint64_t limit_us = 0;
  if (::sd_watchdog_enabled(0, &limit_us) > 0) {
    interval_ = std::min(interval_, std::chrono::milliseconds(limit_us / 2000));
  }
}

void ServiceManager::ready(const std::string& status) const {
  ::sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
}

void ServiceManager::status(const std::string& status) const { ::sd_notify(0, ("STATUS=" + status).c_str()); }

void ServiceManager::stopping() const { ::sd_notify(0, "STOPPING=1"); }

void ServiceManager::alive() const { ::sd_notify(0, "WATCHDOG=1"); }

}  // namespace isobar::bridge

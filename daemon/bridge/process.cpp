// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/process.hpp"

#include <linux/close_range.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigtimedwait is POSIX
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <ctime>

namespace isobar::bridge {
namespace {

std::array<char, PATH_MAX> g_program{};
char** g_arguments = nullptr;

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

// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <initializer_list>

#include "core/errors.hpp"

namespace isobar {

namespace {

/// Blocks signals and makes a descriptor that tells of them.
int signal_descriptor(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  const int descriptor = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (descriptor < 0) throw ServiceError(std::string("signalfd: ") + std::strerror(errno));
  return descriptor;
}

}  // namespace

Service::Service() : signals_(signal_descriptor({SIGTERM, SIGINT})), hangups_(signal_descriptor({SIGHUP})) {
  // A log that nobody reads any more (`isobard | head`) and a limit on the size of files (ulimit -f) are errors of
  // one write, not the end of the program.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

Service::~Service() {
  close(signals_);
  close(hangups_);
}

bool Service::take_reload_request() {
  signalfd_siginfo info{};
  return read(hangups_, &info, sizeof info) == static_cast<ssize_t>(sizeof info);
}

void Service::reloading() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t monotonic_us = std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000;
  sd_notify(0, ("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(monotonic_us)).c_str());
}

// The signal is never read from the descriptor, so it stays pending: every later call returns false, too.
bool Service::wait_for(std::chrono::milliseconds duration) {
  pollfd wait{signals_, POLLIN, 0};
  return poll(&wait, 1, static_cast<int>(duration.count())) <= 0;
}

void Service::supervise(const std::function<bool()>& tick, std::chrono::milliseconds period) {
  // The first tick at once: a bridge that has aborted attaches to isobard in it.
  for (std::chrono::milliseconds wait{0}; wait_for(wait); wait = period) {
    if (tick()) feed_watchdog();
  }
  sd_notify(0, "STOPPING=1");
}

void Service::ready(const std::string& status) {
  sd_notify(0, status.empty() ? "READY=1" : ("READY=1\nSTATUS=" + status).c_str());
}
void Service::set_status(const std::string& status) { sd_notify(0, ("STATUS=" + status).c_str()); }
void Service::extend_start() { sd_notify(0, "EXTEND_TIMEOUT_USEC=10000000"); }
void Service::feed_watchdog() { sd_notify(0, "WATCHDOG=1"); }

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/errors.hpp"

namespace isobar {

Service::Service() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signals_ < 0) throw ServiceError(std::string("signalfd: ") + std::strerror(errno));
}

Service::~Service() { close(signals_); }

// The signal is never read from the descriptor, so it stays pending: every later call returns false, too.
bool Service::wait_for(std::chrono::milliseconds duration) {
  pollfd wait{signals_, POLLIN, 0};
  return poll(&wait, 1, static_cast<int>(duration.count())) <= 0;
}

void Service::supervise(const std::function<bool()>& tick, std::chrono::milliseconds period) {
  while (wait_for(period)) {
    if (tick()) feed_watchdog();
  }
  sd_notify(0, "STOPPING=1");
}

void Service::ready(const std::string& status) {
  sd_notify(0, status.empty() ? "READY=1" : ("READY=1\nSTATUS=" + status).c_str());
}
void Service::set_status(const std::string& status) { sd_notify(0, ("STATUS=" + status).c_str()); }
void Service::feed_watchdog() { sd_notify(0, "WATCHDOG=1"); }

}  // namespace isobar

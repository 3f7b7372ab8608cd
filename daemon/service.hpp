// SPDX-License-Identifier: BSD-3-Clause
// Service interface of a program: stop signals, sd_notify(3) and the supervise loop of the main thread.
// Used by isobard, in both roles, and by isobar-dds.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace isobar {

/// Signals and status of a service. Main thread only, except where noted. Without a service manager the
/// notifications do nothing.
class Service {
 public:
  /// Blocks SIGTERM, SIGINT and SIGHUP in this thread and in all threads
  /// started later: construct it before the first thread. Ignores SIGPIPE and SIGXFSZ: such writes fail.
  /// @throws ServiceError when the kernel refuses a signal descriptor
  Service();
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Sleeps; returns early when a stop signal arrives. Any thread.
  /// @return false once a stop signal has arrived, now or in an earlier call
  [[nodiscard]] bool wait_for(std::chrono::milliseconds duration);

  /// Default period of the supervise loop.
  static constexpr std::chrono::milliseconds kTick{100};
  /// The supervise loop: calls `tick` once a period until a stop signal arrives, then reports STOPPING.
  /// @param tick returns true when it has just checked its threads and none hangs, which feeds the watchdog;
  ///        false in a tick without a check or while a thread hangs
  void supervise(const std::function<bool()>& tick, std::chrono::milliseconds period = kTick);

  /// READY=1, with the line that `systemctl status` shows. Empty: no line.
  void ready(const std::string& status = {});
  /// RELOADING=1 with MONOTONIC_USEC, before a reload; ready() ends it.
  void reloading();
  /// True once after each SIGHUP: `systemctl reload`, or the end of the terminal.
  [[nodiscard]] bool take_reload_request();
  void set_status(const std::string& status);
  /// A start that takes longer: the service manager waits another ten seconds for ready().
  void extend_start();
  void feed_watchdog();

 private:
  int signals_ = -1;
  int hangups_ = -1;
};

}  // namespace isobar

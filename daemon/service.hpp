// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace isobar {

/// A program that runs until SIGTERM or SIGINT and keeps the service manager informed (sd_notify(3); silent
/// where there is none).
class Service {
 public:
  /// Blocks both signals for this thread and all that it starts later: make it before the first thread.
  /// Throws ServiceError.
  Service();
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Waits; false once a signal has come.
  [[nodiscard]] bool wait_for(std::chrono::milliseconds duration);

  void ready();
  void alive();  ///< feeds the service manager's watchdog
  void stopping();

 private:
  int signals_ = -1;
};

}  // namespace isobar

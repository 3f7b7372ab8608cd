// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdlib>
#include <string>

#include "daemon/logging.hpp"
#include "daemon/service.hpp"
#include "ipc/broker.hpp"

namespace isobar {

/// Waits for shared memory while files of another user are in the way, instead of ending: says so at once, then
/// every minute, and in `systemctl status`. A stop signal ends the wait.
inline void wait_for_shared_memory(Service& service) {
  constexpr int kSecondsBetweenLines = 60;
  ipc::set_broker_patience([&service, told = std::string(), seconds = 0](const std::string& reason) mutable {
    if (reason != told || seconds % kSecondsBetweenLines == 0) {
      log_warning(reason + "; waiting until it is gone");
      service.set_status(reason);
      seconds = 0;
    }
    told = reason;
    ++seconds;
    service.extend_start();
    if (service.wait_for(std::chrono::seconds(1))) return true;
    log_info("stopped");
    std::exit(0);  // nothing has been started yet
  });
}

}  // namespace isobar

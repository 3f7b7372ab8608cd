// SPDX-License-Identifier: BSD-3-Clause
// Process control of the bridge: restart in place, and time limits for calls that can block for ever.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "daemon/service.hpp"

namespace isobar::bridge {

/// Stores program path and arguments for replace_process().
void remember_arguments(char** argv);

/// Restarts this program in place, by exec: same process id, same arguments, no other state. Safe in any
/// state of the libraries. Ends the process with code 69 when exec fails.
[[noreturn]] void replace_process() noexcept;

/// replace_process() after 1 s, for faults that may recur at once.
[[noreturn]] void replace_process_later() noexcept;

/// Time limit for calls into iceoryx, which wait without a timeout for isobard's answer and would hang when
/// isobard dies or hangs in between. A thread, not a signal: the thread that made the call may hold locks, or
/// be blocked in one that a stopped isobard holds, and a handler could then not run.
class TimeLimit {
 public:
  /// @param action called in a thread of its own when this object still exists after `limit`; must not return
  TimeLimit(std::chrono::milliseconds limit, void (*action)() noexcept);
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool met_ = false;
  std::thread thread_;
};

/// Ends the process with code 0 and a line on stderr if it has not ended by itself within `limit` of a stop signal,
/// wherever it hangs: while attaching, in the network, or beyond the end of main(), in the clean-up of the libraries.
/// Once, for a service that lives as long as the program.
void limit_stop(Service& service, std::chrono::milliseconds limit);

}  // namespace isobar::bridge

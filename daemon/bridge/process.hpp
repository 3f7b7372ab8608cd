// SPDX-License-Identifier: BSD-3-Clause
// What the bridge has to do with the operating system: signals, the service manager, starting over.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace isobar::bridge {

/// SIGTERM and SIGINT as events of one thread. Make it before any other thread, which then never gets them.
class StopSignals {
 public:
  StopSignals();
  /// True when the program has been told to end, now or before.
  [[nodiscard]] bool wait_for(std::chrono::milliseconds timeout);

 private:
  bool stopped_ = false;
};

/// Remembers how this program was started, so that replace_process() can do it again.
void remember_arguments(char** argv);

/// Starts this program over in place: same process id, same arguments, nothing else kept. Safe in a process
/// whose libraries are in any state. Ends the process with code 69 if the system refuses.
[[noreturn]] void replace_process() noexcept;

/// The same after a second, for faults that may come back at once.
[[noreturn]] void replace_process_later() noexcept;

/// Limits what may otherwise wait for ever: iceoryx sends isobard a request and waits for the answer, so an
/// isobard that dies or hangs in between would hang this process too, even at its end. When the time is up,
/// `action` is called in a signal handler: it must be safe there and must not return. One limit at a time;
/// main thread.
/// @param limit whole seconds, > 0
void limit_time(std::chrono::seconds limit, void (*action)() noexcept);
void lift_time_limit() noexcept;

/// Ends the process with code 0 and says why: for an end that was asked for and takes too long.
[[noreturn]] void end_process() noexcept;

/// Talks to systemd where it is there, and does nothing elsewhere.
class ServiceManager {
 public:
  ServiceManager();
  void ready(const std::string& status) const;
  void status(const std::string& status) const;
  void stopping() const;
  void alive() const;  ///< to be called at least every interval()
  /// Half of the watchdog's time, or half a second where there is none or it is longer.
  [[nodiscard]] std::chrono::milliseconds interval() const { return interval_; }

 private:
  std::chrono::milliseconds interval_{500};
};

}  // namespace isobar::bridge

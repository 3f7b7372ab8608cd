// SPDX-License-Identifier: BSD-3-Clause
// Process control of the bridge: restart in place, and time limits for calls that can block for ever.
#pragma once

#include <chrono>

namespace isobar::bridge {

/// Stores program path and arguments for replace_process().
void remember_arguments(char** argv);

/// Restarts this program in place, by exec: same process id, same arguments, no other state. Safe in any
/// state of the libraries. Ends the process with code 69 when exec fails.
[[noreturn]] void replace_process() noexcept;

/// replace_process() after 1 s, for faults that may recur at once.
[[noreturn]] void replace_process_later() noexcept;

/// Sets a time limit for calls into iceoryx, which wait without a timeout for isobard's answer and would hang
/// when isobard dies or hangs in between. One limit at a time; main thread.
/// @param limit whole seconds, > 0
/// @param action called in a signal handler when the time is up: async-signal-safe, must not return
void set_time_limit(std::chrono::seconds limit, void (*action)() noexcept);
void clear_time_limit() noexcept;

/// Ends the process with code 0 and a line on stderr: for a requested stop that exceeds its time limit.
[[noreturn]] void end_process() noexcept;

}  // namespace isobar::bridge

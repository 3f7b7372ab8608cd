// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "ipc/topics.hpp"

namespace isobar::tools {

/// Reads the health reports of the isobard on this machine. One per process: a process can attach to shared
/// memory only once.
class HealthReader {
 public:
  /// @param program name under which this process attaches
  /// @param timeout longest wait for a running isobard
  /// @param hang_code exit code of this process when isobard runs but does not answer, see HangLimit
  /// @throws ServiceError when none runs, or when this user may not attach to it
  HealthReader(const char* program, std::chrono::milliseconds timeout, int hang_code);
  ~HealthReader();
  HealthReader(const HealthReader&) = delete;
  HealthReader& operator=(const HealthReader&) = delete;

  /// Waits for the next report; the first one is there already if isobard has run for a second.
  /// @return false when none has arrived within the timeout
  bool next(ipc::HealthReport& report, std::chrono::milliseconds timeout);
  /// False once that isobard has ended. Only a new process can attach to the next one: see run_again().
  [[nodiscard]] bool alive() const noexcept;
  /// Time since the report was made [s].
  [[nodiscard]] static double age_s(const ipc::HealthReport& report) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Replaces this process by itself, with the same arguments.
[[noreturn]] void run_again();

/// Ends this process with this exit code. The shared-memory library detaches at the end of the process and
/// could wait for ever for an isobard that hangs: it has two seconds.
[[noreturn]] void end_attached(int exit_code);

}  // namespace isobar::tools

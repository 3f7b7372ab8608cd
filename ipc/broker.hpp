// SPDX-License-Identifier: BSD-3-Clause
// Lifetime of the shared memory: the process that creates it, and the processes that attach to it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace isobar::ipc {

/// Non-fatal errors reported by the shared-memory library since this process started.
[[nodiscard]] std::uint64_t library_fault_count() noexcept;

/// Replaces the default reaction to a fatal error of the shared-memory library, which ends the process with
/// exit code 69. The action must not return and must not call the library; it may replace the process by
/// exec.
using FatalAction = void (*)();
void set_fatal_action(FatalAction action) noexcept;

/// What a Broker does while files or locks of another user are in its way. Called about once a second with the
/// reason, one sentence with the remedy; it waits, and returns false to give up. Default: gives up at once.
using BrokerPatience = std::function<bool(const std::string& reason)>;
void set_broker_patience(BrokerPatience patience);

/// Checks the files by which other processes find the Broker of this process, and makes its lock file again if
/// somebody has removed it. Call once a second; costs a few system calls.
/// @return names of the files that were removed and cannot be made again, so that no process can attach any
///         more until the Broker is made anew; empty: all are there. Attached processes keep their connection.
[[nodiscard]] std::string check_broker_files();

/// Creates the shared memory and serves the attached processes, in threads of its own.
class Broker {
 public:
  /// @throws ServiceError when another isobard runs on this machine, when /dev/shm is too small (the text
  ///         gives the MB needed and available), when the system refuses shared memory, or when files of
  ///         another user are in the way and the patience has ended, see set_broker_patience()
  Broker();
  /// Attached processes keep running but receive nothing more. Waits up to 0.5 s for them to detach.
  ~Broker();
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  /// Free space that a Broker needs in /dev/shm [bytes].
  [[nodiscard]] static std::uint64_t needed_bytes() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Attaches this process to the shared memory of a running isobard. Once per process: the library cannot
/// attach a second time.
class Attachment {
 public:
  /// Waits for isobard to run.
  /// @param name program name, up to 60 characters that are valid in a file name; the process id is appended
  /// @param timeout longest wait; 0: one attempt
  /// @throws ServiceError when no isobard runs within the timeout
  Attachment(const char* name, std::chrono::milliseconds timeout);
  ~Attachment();
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;

  /// False once the isobard of this attachment has ended, even if another one has started since. From then on
  /// no message arrives; only a new process can attach again. Call it every 0.1 s, and detach then: an isobard
  /// that ends waits for its attached processes, up to 0.5 s. Costs a few system calls.
  [[nodiscard]] bool broker_alive() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isobar::ipc

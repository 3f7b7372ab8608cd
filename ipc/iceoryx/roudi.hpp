// SPDX-License-Identifier: BSD-3-Clause
// RouDi, iceoryx's broker, inside this process.
#pragma once

#include <sys/types.h>

#include <iceoryx_posh/internal/roudi/roudi.hpp>
#include <mutex>
#include <utility>
#include <vector>

namespace isobar::ipc {

/// The attached processes, each held by a pidfd (pidfd_open(2)). Any thread.
class AttachedProcesses {
 public:
  AttachedProcesses() = default;
  ~AttachedProcesses();
  AttachedProcesses(const AttachedProcesses&) = delete;
  AttachedProcesses& operator=(const AttachedProcesses&) = delete;

  void add(const iox::RuntimeName_t& name, pid_t pid);
  /// Removes the processes that have ended and returns their names.
  [[nodiscard]] std::vector<iox::RuntimeName_t> remove_ended();

 private:
  std::mutex mutex_;
  std::vector<std::pair<iox::RuntimeName_t, int>> processes_;  // second: pidfd
};

/// RouDi that unregisters a process when the kernel reports its end, instead of after a missing heartbeat.
///
/// The library's monitoring compares clock readings: an isobard suspended for 1.5 s (a debugger, a frozen
/// machine) would unregister every process on resuming, itself included, which ends it. A hanging process
/// needs no removal, because full queues drop their oldest message.
class PidfdRouDi : private AttachedProcesses,  // base class first: RouDi's constructor starts threads
                   public iox::roudi::RouDi {
 public:
  PidfdRouDi(iox::roudi::RouDiMemoryInterface& memory, iox::roudi::PortManager& ports);
  ~PidfdRouDi() override;
  PidfdRouDi(const PidfdRouDi&) = delete;
  PidfdRouDi& operator=(const PidfdRouDi&) = delete;

 private:
  /// Records the process id of each process that registers.
  void processMessage(const iox::runtime::IpcMessage& message, const iox::runtime::IpcMessageType& command,
                      const iox::RuntimeName_t& name) noexcept override;
  /// Unregisters the processes that have ended. RouDi calls it every 100 ms.
  void cyclicUpdateHook() noexcept override;
};

}  // namespace isobar::ipc

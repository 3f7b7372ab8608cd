// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/iceoryx/roudi.hpp"

#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

#include "ipc/leftovers.hpp"

namespace isobar::ipc {

AttachedProcesses::~AttachedProcesses() {
  for (const auto& [name, descriptor] : processes_) ::close(descriptor);
}

void AttachedProcesses::add(const iox::RuntimeName_t& name, pid_t pid) {
  const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  const std::lock_guard lock(mutex_);
  if (descriptor >= 0) processes_.emplace_back(name, descriptor);
}

std::vector<iox::RuntimeName_t> AttachedProcesses::remove_ended() {
  const std::lock_guard lock(mutex_);
  std::vector<iox::RuntimeName_t> ended;
  std::erase_if(processes_, [&ended](const auto& process) {
    pollfd end_of_process{process.second, POLLIN, 0};
    if (::poll(&end_of_process, 1, 0) <= 0) return false;
    ended.push_back(process.first);
    ::close(process.second);
    return true;
  });
  return ended;
}

PidfdRouDi::PidfdRouDi(iox::roudi::RouDiMemoryInterface& memory, iox::roudi::PortManager& ports)
    : RouDi(memory, ports,
            RoudiStartupParameters(iox::roudi::MonitoringMode::OFF, /*killProcessesInDestructor=*/false,
                                   RuntimeMessagesThreadStart::DEFER_START)) {
  startProcessRuntimeMessagesThread();
}

PidfdRouDi::~PidfdRouDi() { shutdown(); }

void PidfdRouDi::processMessage(const iox::runtime::IpcMessage& message,
                                const iox::runtime::IpcMessageType& command,
                                const iox::RuntimeName_t& name) noexcept {
  constexpr std::uint32_t kRegisterElementCount = 6;
  RouDi::processMessage(message, command, name);
  if (command != iox::runtime::IpcMessageType::REG ||
      message.getNumberOfElements() != kRegisterElementCount) {
    return;
  }
  std::uint32_t pid = 0;
  uid_t user = 0;
  std::int64_t sent = 0;
  static_cast<void>(parseRegisterMessage(message, pid, user, sent));
  if (static_cast<pid_t>(pid) != ::getpid()) add(name, static_cast<pid_t>(pid));
}

void PidfdRouDi::cyclicUpdateHook() noexcept {
  for (const iox::RuntimeName_t& name : remove_ended()) {
    static_cast<void>(m_prcMgr->unregisterProcess(name));
    remove_files_of({name.c_str(), name.size()});
  }
}

}  // namespace isobar::ipc

// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/iceoryx/library_errors.hpp"

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iceoryx_hoofs/error_handling/error_handling.hpp>
#include <iceoryx_hoofs/log/logmanager.hpp>
#include <iostream>

#include "ipc/broker.hpp"

namespace isobar::ipc {
namespace {

/// EX_UNAVAILABLE of sysexits.h, the exit code of ServiceError.
constexpr int kServiceUnavailable = 69;

std::atomic<std::uint64_t> g_library_faults{0};
std::atomic<FatalAction> g_fatal_action{nullptr};

/// Whether the error is an answer of the broker that a program did not read: it was killed, or it ended without
/// detaching. Part of normal operation, no fault of the library.
bool is_answer_to_ended_program(iox::Error error) {
  return error == iox::Error::kPOSH__ROUDI_PROCESS_SEND_VIA_IPC_CHANNEL_FAILED;
}

void handle_library_error(const iox::Error error, const std::function<void()>& /*callback*/,
                          const iox::ErrorLevel level) {
  if (is_answer_to_ended_program(error)) return;
  g_library_faults.fetch_add(1, std::memory_order_relaxed);
  if (level != iox::ErrorLevel::FATAL) {
    return;
  }
  // Never return to the library: its state is invalid, and its destructors would fail as well.
  // In the journal the number in front is the priority, sd-daemon(3).
  std::fprintf(stderr, "%sshared memory: fatal error %s in the iceoryx library\n",
               std::getenv("JOURNAL_STREAM") != nullptr ? "<3>" : "", iox::ErrorHandler::toString(error));
  if (const FatalAction action = g_fatal_action.load()) {
    action();
  }
  std::_Exit(kServiceUnavailable);
}

}  // namespace

std::uint64_t library_fault_count() noexcept { return g_library_faults.load(std::memory_order_relaxed); }

void set_fatal_action(FatalAction action) noexcept { g_fatal_action.store(action); }

// Without a handler, Debian's build of iceoryx aborts on SEVERE errors, too. The guard object would restore
// the default handler, hence it is leaked.
void prepare_library() {
  static const bool kPrepared = [] {
    iox::log::LogManager::GetLogManager().SetDefaultLogLevel(iox::log::LogLevel::kOff,
                                                             iox::log::LogLevelOutput::kHideLogLevel);
    // Failed system calls are printed regardless of the log level, several lines for each.
    std::cerr.rdbuf(nullptr);
    static auto* kept = new iox::cxx::GenericRAII(
        iox::ErrorHandler::setTemporaryErrorHandler(iox::HandlerFunction(handle_library_error)));
    return kept != nullptr;
  }();
  static_cast<void>(kPrepared);
}

}  // namespace isobar::ipc

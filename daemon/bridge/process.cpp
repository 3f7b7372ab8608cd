// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/process.hpp"

#include <linux/close_range.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace isobar::bridge {
namespace {

std::array<char, PATH_MAX> g_program{};
char** g_arguments = nullptr;

[[noreturn]] void end_process() noexcept {
  constexpr std::string_view kReason =
      "isobar-dds: the stop takes too long, isobard or the network does not answer; ended without "
      "detaching\n";
  static_cast<void>(::write(STDERR_FILENO, kReason.data(), kReason.size()) > 0);
  std::_Exit(0);
}

}  // namespace

void remember_arguments(char** argv) {
  g_arguments = argv;
  // The path, not /proc/self/exe itself: after an upgrade the path names the new program.
  const ssize_t length = ::readlink("/proc/self/exe", g_program.data(), g_program.size() - 1);
  if (length > 0) {
    g_program[static_cast<std::size_t>(length)] = '\0';
  }
}

void replace_process() noexcept {
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  if (g_arguments != nullptr) {
    ::execv(g_program.data(), g_arguments);
    ::execv("/proc/self/exe", g_arguments);  // the program's file was removed
  }
  std::_Exit(69);  // EX_UNAVAILABLE
}

void replace_process_later() noexcept {
  const timespec second{1, 0};
  ::nanosleep(&second, nullptr);
  replace_process();
}

TimeLimit::TimeLimit(std::chrono::milliseconds limit, void (*action)() noexcept)
    : thread_([this, end = std::chrono::steady_clock::now() + limit, action] {
        std::unique_lock lock(mutex_);
        if (!ended_.wait_until(lock, end, [this] { return met_; })) action();
      }) {}

TimeLimit::~TimeLimit() {
  {
    const std::lock_guard lock(mutex_);
    met_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void limit_stop(Service& service, std::chrono::milliseconds limit) {
  std::thread([&service, limit] {
    constexpr std::chrono::hours kAgain{1};
    while (service.wait_for(kAgain)) {
    }
    std::this_thread::sleep_for(limit);
    end_process();
  }).detach();
}

}  // namespace isobar::bridge

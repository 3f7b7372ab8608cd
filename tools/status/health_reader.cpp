// SPDX-License-Identifier: BSD-3-Clause
#include "tools/status/health_reader.hpp"

#include <linux/close_range.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/service_view.hpp"
#include "ipc/shared_memory.hpp"
#include "tools/status/hang_limit.hpp"

namespace isobar::tools {
namespace {

/// Attaching takes milliseconds.
constexpr unsigned kAttachLimitS = 5;
constexpr unsigned kDetachLimitS = 2;
volatile std::sig_atomic_t g_exit_code = 0;

}  // namespace

struct HealthReader::Impl {
  ipc::Attachment attachment;
  ipc::Subscriber<ipc::HealthReport> reports{ipc::topics::kHealth};
  ipc::Waiter waiter{&reports.raw()};

  explicit Impl(const char* program) : attachment(program, std::chrono::milliseconds(0)) {}

  /// @param hang_code see HangLimit
  static std::unique_ptr<Impl> attach(const char* program, int hang_code) {
    const HangLimit limit(kAttachLimitS, hang_code);
    return std::make_unique<Impl>(program);
  }
};

HealthReader::HealthReader(const char* program, std::chrono::milliseconds timeout, int hang_code) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  bool said = false;
  while (!impl_) {
    try {
      impl_ = Impl::attach(program, hang_code);
    } catch (const ServiceError& error) {
      if (std::chrono::steady_clock::now() >= deadline) throw;
      if (!said) std::fprintf(stderr, "isobar: %s; waiting\n", error.what());
      said = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      ipc::enter_service_view();
    }
  }
}

HealthReader::~HealthReader() = default;

bool HealthReader::next(ipc::HealthReport& report, std::chrono::milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + timeout;
  for (;;) {
    if (const auto newest = impl_->reports.take_latest()) {
      report = *newest;
      return true;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0 || !alive()) return false;
    static_cast<void>(impl_->waiter.wait_for(std::min(left, std::chrono::milliseconds(200))));
  }
}

bool HealthReader::alive() const noexcept { return impl_->attachment.broker_alive(); }

double HealthReader::age_s(const ipc::HealthReport& report) noexcept {
  return static_cast<double>(monotonic_ns() + report.robot_clock_offset_ns - report.stamp_ns) * 1e-9;
}

void run_again() {
  std::fflush(nullptr);
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < text.size(); at = text.find('\0', at) + 1) arguments.push_back(&text[at]);
  arguments.push_back(nullptr);
  // The library's lock on this process's name would be inherited and refuse the new program.
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  if (arguments.size() > 1) execv("/proc/self/exe", arguments.data());
  std::_Exit(69);
}

void end_attached(int exit_code) {
  std::fflush(nullptr);
  g_exit_code = exit_code;
  std::signal(SIGALRM, [](int) { _exit(g_exit_code); });
  alarm(kDetachLimitS);
  std::exit(exit_code);
}

}  // namespace isobar::tools

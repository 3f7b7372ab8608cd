// SPDX-License-Identifier: BSD-3-Clause
// `isobar blackbox`: orders to the black box of the running isobard.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>

#include "core/errors.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/service_view.hpp"
#include "ipc/shared_memory.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/status/hang_limit.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

struct SaveOptions {
  std::string reason = "order";
  double timeout_s = 60.0;
};

struct StateOptions {};

constexpr auto kBlackBoxAttachTimeout = 3s;
/// Beyond --timeout: attaching and detaching take milliseconds.
constexpr unsigned kHangLimitS = 5;
/// Time within which a running black box tells its state: it does so once a second.
constexpr auto kStateTimeout = 3s;

/// The black box of the running isobard.
class BlackBoxLink {
 public:
  /// @throws ServiceError when no isobard runs, or its black box is off
  BlackBoxLink() {
    if (!next_state(kStateTimeout)) {
      throw ServiceError("isobard's black box does not answer: black_box.span_s is 0, or isobard is stopped");
    }
  }

  [[nodiscard]] const ipc::BlackBoxState& state() const { return state_; }

  /// Waits for the next state. False when none comes in time.
  bool next_state(std::chrono::milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (std::chrono::steady_clock::now() < end) {
      if (const auto newest = states_.take_latest()) {
        state_ = *newest;
        return true;
      }
      if (!attachment_.broker_alive()) throw ServiceError("isobard has ended");
      std::this_thread::sleep_for(20ms);
    }
    return false;
  }

  /// Sends an order until the black box has taken it and finished.
  /// @throws ServiceError when it does not within the timeout
  void save(const SaveOptions& options) {
    ipc::BlackBoxOrder order;
    order.number = static_cast<std::uint64_t>(monotonic_ns()) ^ static_cast<std::uint64_t>(::getpid());
    ipc::copy_to_field(options.reason, order.reason);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.timeout_s);
    while (!orders_.has_subscribers() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(10ms);
    }
    orders_.send(order);
    while (state_.answered != order.number) {
      if (std::chrono::steady_clock::now() > end) {
        throw ServiceError("isobard has not finished saving within the time limit; it goes on, see its log");
      }
      (void)next_state(200ms);
    }
  }

 private:
  ipc::Attachment attachment_{"isobar-blackbox", kBlackBoxAttachTimeout};
  ipc::Subscriber<ipc::BlackBoxState> states_{ipc::topics::kBlackBoxState};
  ipc::Publisher<ipc::BlackBoxOrder> orders_{ipc::topics::kBlackBoxOrder};
  ipc::BlackBoxState state_;
};

void run_save(const SaveOptions& options) {
  ipc::enter_service_view();
  const HangLimit limit(kHangLimitS + static_cast<unsigned>(options.timeout_s), 69);
  BlackBoxLink link;
  link.save(options);
  if (link.state().last_failed) throw ServiceError(std::string("not saved: ") + link.state().last);
  std::printf("written: %s\n", link.state().last);
}

void run_state(const StateOptions&) {
  constexpr double kMb = 1e6;
  ipc::enter_service_view();
  const HangLimit limit(kHangLimitS, 69);
  const BlackBoxLink link;
  const ipc::BlackBoxState& state = link.state();
  std::printf("holds %.1f s in %.1f MB (at most %.0f MB); %llu inputs lost\n",
              static_cast<double>(state.held_ns) * 1e-9, static_cast<double>(state.held_bytes) / kMb,
              static_cast<double>(state.limit_bytes) / kMb, static_cast<unsigned long long>(state.dropped));
  std::printf("saved %llu times, failed %llu times since the start\n",
              static_cast<unsigned long long>(state.saved), static_cast<unsigned long long>(state.failed));
  if (state.last[0] != '\0') std::printf("newest: %s\n", state.last);
}

}  // namespace

void add_black_box_command(CLI::App& app) {
  CLI::App* black_box =
      app.add_subcommand("blackbox", "The last minute of inputs, kept by the running isobard");
  black_box->require_subcommand(1);
  const auto [save, options] =
      add_subcommand<SaveOptions>(*black_box, "save", "Write it to the disk as a recording", run_save);
  save.add_option("--reason", options.reason, "part of the folder's name")->capture_default_str();
  save.add_option("--timeout", options.timeout_s, "longest wait for the end of writing [s]")
      ->check(number_within(1.0, 3'600.0))
      ->capture_default_str();
  add_subcommand<StateOptions>(*black_box, "status", "What it holds, and what it has saved", run_state);
}

}  // namespace isobar::tools

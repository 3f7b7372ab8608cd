// SPDX-License-Identifier: BSD-3-Clause
// `isobar reset`: asks the running isobard for a new map frame.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string_view>

#include "core/errors.hpp"
#include "ipc/broker.hpp"
#include "ipc/channel.hpp"
#include "ipc/service_view.hpp"
#include "tools/commands.hpp"
#include "tools/status/hang_limit.hpp"
#include "tools/subcommand.hpp"
#include "tools/wait_until.hpp"

namespace isobar::tools {

namespace {

using std::chrono::milliseconds;

/// Beyond --timeout: attaching and detaching take milliseconds.
constexpr unsigned kResetLimitS = 5;

struct ResetOptions {
  double timeout_s = 5.0;
};

/// Number of the map frame in isobard's newest health report; nothing without one.
std::optional<std::uint32_t> session_in(ipc::Subscriber<ipc::HealthReport>& reports) {
  const auto report = reports.take_latest();
  if (!report) return std::nullopt;
  for (std::uint32_t i = 0; i < report->entry_count; ++i) {
    if (std::string_view(report->entries[i].name) == "session") {
      return static_cast<std::uint32_t>(report->entries[i].value);
    }
  }
  return std::nullopt;
}

void run_reset(const ResetOptions& options) {
  const auto end =
      std::chrono::steady_clock::now() + milliseconds(static_cast<std::int64_t>(options.timeout_s * 1e3));
  ipc::enter_service_view();
  const HangLimit limit(kResetLimitS + static_cast<unsigned>(options.timeout_s), 69);
  const ipc::Attachment attachment("isobar-reset", milliseconds(2'000));
  ipc::Subscriber<ipc::HealthReport> reports(ipc::topics::kHealth);
  ipc::Publisher<ipc::CommandMessage> commands(ipc::topics::kCommand);
  std::optional<std::uint32_t> before;
  const bool heard = wait_until(end, [&] {
    if (const auto session = session_in(reports)) before = session;
    return before.has_value() && commands.has_subscribers();
  });
  if (!heard) throw ServiceError("isobard does not answer; is this a base station?");
  if (!commands.send({ipc::Command::kNewFrame})) throw ServiceError("no shared memory is free");
  const bool done = wait_until(end, [&] { return session_in(reports).value_or(*before) != *before; });
  if (!done) throw ServiceError("isobard has not begun a new frame in time");
  std::printf("a new map frame has begun; the old map and trajectory are kept\n");
}

}  // namespace

void add_reset_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<ResetOptions>(
      app, "reset", "Begin a new map frame in the running isobard; the old map is kept", run_reset);
  command.add_option("--timeout", options.timeout_s, "longest wait [s]")->capture_default_str();
}

}  // namespace isobar::tools

// SPDX-License-Identifier: BSD-3-Clause
// `isobar status`: one screen about the running isobard.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "core/errors.hpp"
#include "ipc/service_view.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/status/hang_limit.hpp"
#include "tools/status/health_reader.hpp"
#include "tools/status/view.hpp"

namespace isobar::tools {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Longest wait for a report of a running isobard, which makes one a second.
constexpr auto kReportTimeout = 4s;
/// Exit code when isobard runs, but sends no report.
constexpr int kHangs = 2;
constexpr const char* kClearScreen = "\033[H\033[J";

struct StatusOptions {
  bool json = false;
  bool watch = false;
  bool all = false;
  double wait_s = 0.0;
};

volatile std::sig_atomic_t g_stop_status = 0;

/// Exit codes of monitoring plugins: 0 ok, 1 warning, 2 error, 3 stale.
int exit_code(const ipc::HealthReport& report) {
  if (report.entry_count == 0 || HealthReader::age_s(report) > kOldReportS) return kHangs;
  return static_cast<int>(report.entries[0].level);
}

void show(const ipc::HealthReport& report, const StatusOptions& options) {
  const double age_s = HealthReader::age_s(report);
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const std::string text = options.json ? status_json(report, age_s) + "\n"
                                        : status_text(report, age_s, {.color = terminal, .all = options.all});
  std::printf("%s%s", options.watch && terminal && !options.json ? kClearScreen : "", text.c_str());
  std::fflush(stdout);
}

/// Shows each report until a signal comes.
void watch(HealthReader& reader, const StatusOptions& options, ipc::HealthReport& report) {
  std::signal(SIGINT, [](int) { g_stop_status = 1; });
  std::signal(SIGTERM, [](int) { g_stop_status = 1; });
  show(report, options);
  while (g_stop_status == 0) {
    if (!reader.alive()) {
      std::fprintf(stderr, "isobar: isobard has ended; waiting for the next one\n");
      run_again();
    }
    const bool is_new = reader.next(report, 1s);
    // An old one with its age.
    if (is_new || (HealthReader::age_s(report) > kOldReportS && reader.alive())) show(report, options);
  }
}

void run_status(const StatusOptions& options) {
  // A watch begins before isobard does.
  const auto wait = options.watch ? std::chrono::hours(24 * 365)
                                  : std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::duration<double>(options.wait_s));
  ipc::enter_service_view();
  HealthReader reader("isobar-status", wait, options.watch ? HangLimit::kWait : kHangs);
  ipc::HealthReport report;
  if (!reader.next(report, kReportTimeout)) {
    throw Error(
        "isobard runs but sends no health report: it hangs, is just starting, or comes from another build",
        kHangs);
  }
  if (options.watch) {
    watch(reader, options, report);
  } else {
    show(report, options);
  }
  end_attached(exit_code(report));
}

}  // namespace

void add_status_command(CLI::App& app) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command =
      app.add_subcommand("status",
                         "Show health, sensors, pose, height, map and times of the running isobard.\n"
                         "Exit codes: 0 ok, 1 warning, 2 error, 3 waiting for data, 69 not running.");
  command->add_flag("--json", options->json, "one line of JSON, as docs/health.md describes");
  command->add_flag("--watch", options->watch, "again at each report, once a second; waits for isobard");
  command->add_flag("--all", options->all, "all health entries, not only those that are not ok");
  command->add_option("--wait", options->wait_s, "longest wait for isobard to run [s]")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str();
  command->callback([options] { run_status(*options); });
}

}  // namespace isobar::tools

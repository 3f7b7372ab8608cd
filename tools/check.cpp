// SPDX-License-Identifier: BSD-3-Clause
// `isobar check`: what the sensors of a recording contradict.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include "config/config_io.hpp"
#include "core/contradictions/finding_text.hpp"
#include "core/errors.hpp"
#include "daemon/recording_check.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/recording_reader.hpp"
#include "tools/commands.hpp"
#include "tools/progress.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

/// Exit code of a recording with contradictions: of no failure in sysexits.h.
constexpr int kContradictionsFound = 1;

struct CheckOptions {
  std::filesystem::path recording;
  std::filesystem::path config;
};

/// Ends the command with its exit code after everything has been printed.
class ContradictionsFound : public Error {
 public:
  explicit ContradictionsFound(std::size_t count)
      : Error(std::to_string(count) + (count == 1 ? " contradiction" : " contradictions"),
              kContradictionsFound) {}
};

void print_streams(const RecordingCheck& check) {
  std::int64_t begin_ns = std::numeric_limits<std::int64_t>::max();
  for (const StreamTimes& times : check.times) {
    if (times.count() > 0) begin_ns = std::min(begin_ns, times.first_ns());
  }
  std::printf("%-16s %9s %9s %14s %12s %6s %10s\n", "sensor", "samples", "rate Hz", "from s", "for s", "gaps",
              "longest s");
  for (const auto& [sensor, name] : kCheckedSensorNames.entries) {
    const StreamTimes& times = check.times[static_cast<std::size_t>(sensor)];
    if (times.count() == 0) continue;
    std::printf("%-16s %9llu %9.2f %14.3f %12.3f %6llu %10.3f\n", name.data(),
                static_cast<unsigned long long>(times.count()), times.rate_hz(),
                seconds_between(begin_ns, times.first_ns()), times.length_s(),
                static_cast<unsigned long long>(times.gaps()), times.longest_gap_s());
  }
}

void print_overlaps(const RecordingCheck& check) {
  std::printf("\n%-34s %12s %12s\n", "pair", "overlap s", "of shorter");
  const auto& names = kCheckedSensorNames.entries;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const StreamTimes& a = check.times[i];
      const StreamTimes& b = check.times[j];
      if (a.count() == 0 || b.count() == 0) continue;
      const double shorter_s = std::min(a.length_s(), b.length_s());
      const double common_s = std::max(0.0, overlap_s(a, b));
      std::printf("%-34s %12.3f %11.0f%%\n",
                  (std::string(names[i].name) + " and " + std::string(names[j].name)).c_str(),
                  overlap_s(a, b), shorter_s > 0.0 ? 100.0 * common_s / shorter_s : 0.0);
    }
  }
}

void run_check(const CheckOptions& options) {
  const Config config = options.config.empty() ? Config{} : load_config(options.config);
  const recording::RecordingReader reader(options.recording);
  Progress progress("checking");
  const RecordingCheck check = check_recording(options.recording, with_sensors_of(reader.manifest(), config),
                                               [&](double fraction) { progress.update(fraction); });
  progress.finish();
  print_streams(check);
  print_overlaps(check);
  std::printf("\n");
  for (const std::string& warning : check.warnings) std::printf("note: %s\n", warning.c_str());
  for (const std::string& note : check.notes) std::printf("note: %s\n", note.c_str());
  if (!check.base_clock.empty()) std::printf("base station clock: %s\n", check.base_clock.c_str());
  for (const Finding& finding : check.findings.all()) {
    std::printf("contradiction: %s\n", finding_text(finding).c_str());
  }
  if (!check.silent_lidar.empty()) {
    std::fflush(stdout);
    throw DataError(options.recording.string() + ": " + check.silent_lidar);
  }
  if (check.findings.empty()) {
    std::printf("no contradictions\n");
    return;
  }
  const std::string left_out = left_out_text(check.usable);
  if (!left_out.empty()) std::printf("a replay leaves out what is wrong: %s\n", left_out.c_str());
  std::fflush(stdout);
  throw ContradictionsFound(check.findings.all().size());
}

}  // namespace

void add_check_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<CheckOptions>(
      app, "check", "Find what the sensors of a recording contradict: mounts, units, clocks (exit code 1)",
      run_check);
  command.add_option("RECORDING", options.recording, "recording folder")->required();
  command.add_option("--config", options.config,
                     "TOML file; its sensors and mounts are replaced by the recording's");
}

}  // namespace isobar::tools

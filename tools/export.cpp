// SPDX-License-Identifier: BSD-3-Clause
// `isobar export`: a finished run in the format of another tool.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "run/mcap/run_export.hpp"
#include "tools/commands.hpp"
#include "tools/output_option.hpp"
#include "tools/progress.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct ExportOptions {
  std::filesystem::path run;
  std::filesystem::path recording;
  std::filesystem::path out;
  bool mcap = false;
};

void run_export(const ExportOptions& options) {
  if (!options.mcap) throw UsageError("--mcap: missing; it is the format that is written");
  require_path(options.run, "the folder of a run with trajectory.tum");
  const std::filesystem::path out = options.out.empty() ? beside(options.run, ".mcap") : options.out;
  Progress progress("exporting");
  const mcap::ExportedRun done =
      mcap::export_run({options.run, options.recording, out, version_line("isobar")},
                       [&](double fraction) { progress.update(fraction); });
  progress.finish();
  for (const std::string& note : done.notes) std::printf("note: %s\n", note.c_str());
  std::printf("written: %s: %llu messages, %.1f MB\n", out.c_str(),
              static_cast<unsigned long long>(done.messages), 1e-6 * static_cast<double>(done.bytes));
}

}  // namespace

void add_export_command(CLI::App& app) {
  const auto [command, options] =
      add_subcommand<ExportOptions>(app, "export", "Write a run for Foxglove and ROS 2 tools", run_export);
  command.add_option("RUN", options.run, "folder of a run")->required();
  command.add_flag("--mcap", options.mcap,
                   "as MCAP: poses, paths, transforms, heights, map as ROS 2 messages");
  command.add_option("--recording", options.recording,
                     "recording of the run: its IMU, barometers, wheels and mounts as well");
  command.add_option("--out", options.out, "file to write, replaced if it exists (default: RUN.mcap)")
      ->check(written_as({".mcap"}));
}

}  // namespace isobar::tools

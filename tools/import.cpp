// SPDX-License-Identifier: BSD-3-Clause
// `isobar import`: what others recorded, as a recording folder.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/commands.hpp"
#include "tools/import_options.hpp"
#include "tools/stop_signals.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {
namespace {

void run_import(const ImportRequest& request) {
  const StopSignals signals;
  import_and_print(request);
  std::printf("written: %s\n", request.out.c_str());
}

}  // namespace

void add_import_command(CLI::App& app) {
  const auto [command, request] = add_subcommand<ImportRequest>(
      app, "import", "Make a recording of a bag, a capture, scans or logs that others recorded", run_import);
  command
      .add_option("SOURCE", request.source,
                  "rosbag1, rosbag2, MCAP; pcap or pcapng; a folder of PCD, PLY or KITTI scans; a log")
      ->required();
  command.add_option("--out", request.out, "new folder of the recording")->required();
  add_import_options(command, request);
}

}  // namespace isobar::tools

// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/options.hpp"

#include <CLI/CLI.hpp>

#include "core/version.hpp"

namespace isobar {

void add_options(CLI::App& app, Options& options) {
  app.name("isobard");
  app.description(
      "isobard: pose of a robot from lidar, IMU, wheels and air pressure.\n"
      "Exit codes: 0 stopped by a signal, 64 usage, 69 service unavailable, 78 bad configuration.");
  app.set_version_flag("--version", version_line("isobard"));
  app.add_option("--config", options.config_file,
                 "TOML file; `isobar config show` prints every key with its default")
      ->type_name("FILE");
  app.add_option("--output", options.output_directory,
                 "folder for trajectory.tum, map.ply, map/, status.csv; overrides [output]")
      ->type_name("FOLDER");
}

}  // namespace isobar

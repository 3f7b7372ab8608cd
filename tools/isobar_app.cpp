// SPDX-License-Identifier: BSD-3-Clause
#include "tools/isobar_app.hpp"

#include <CLI/CLI.hpp>

#include "core/version.hpp"
#include "tools/command_examples.hpp"
#include "tools/commands.hpp"

namespace isobar::tools {

void add_all_commands(CLI::App& app) {
  app.name("isobar");
  app.description(
      "Isobar: lidar localisation whose height comes from air pressure.\n"
      "Exit codes: 0 done, 1 `check` found contradictions, 64 usage, 65 bad data, 69 service unavailable, 78 "
      "bad configuration.");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_line("isobar"));
  app.get_formatter()->column_width(32);
  add_simulate_command(app);
  add_import_command(app);
  add_check_command(app);
  add_replay_command(app);
  add_evaluate_command(app);
  add_compare_command(app);
  add_experiment_command(app);
  add_noise_command(app);
  add_altitude_command(app);
  add_calibrate_command(app);
  add_play_command(app);
  add_map_command(app);
  add_export_command(app);
  add_report_command(app);
  add_status_command(app);
  add_metrics_command(app);
  add_web_command(app);
  add_record_command(app);
  add_black_box_command(app);
  add_config_command(app);
  add_reset_command(app);
  add_initial_pose_command(app);
  add_points_command(app);
  add_keys_command(app);
#if ISOBAR_WITH_DDS
  add_echo_command(app);
  add_foxglove_command(app);
#endif
  add_examples(app);
}

}  // namespace isobar::tools

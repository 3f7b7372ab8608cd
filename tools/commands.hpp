// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `isobar`, one file each. Each function adds a subcommand to the parser; an isobar::Error
// thrown by the subcommand ends the program with that error's exit code.
#pragma once

namespace CLI {
class App;
}

namespace isobar::tools {

void add_simulate_command(CLI::App& app);               ///< scenario -> recording
void add_replay_command(CLI::App& app);                 ///< recording -> trajectory, map, status
void add_import_command(CLI::App& app);                 ///< bag, capture, scans, logs of others -> recording
void add_check_command(CLI::App& app);                  ///< recording -> contradictions of its sensors
void add_evaluate_command(CLI::App& app);               ///< reference and estimates -> figures, report
void add_experiment_command(CLI::App& app);             ///< simulate, replay with all methods, evaluate
void add_sensitivity_command(CLI::App& experiment);     ///< subcommand of experiment: steps of two barometers
void add_experiment_all_command(CLI::App& experiment);  ///< subcommand of experiment: every scenario
void add_experiment_sessions_command(
    CLI::App& experiment);                  ///< subcommand of experiment: sessions in a stored map
void add_calibrate_command(CLI::App& app);  ///< sensor and reference logs -> compensation, report
void add_calibrate_mounts_command(
    CLI::App& calibrate);                      ///< subcommand of calibrate: recordings -> mount of the lidar
void add_config_command(CLI::App& app);        ///< check and show a configuration
void add_play_command(CLI::App& app);          ///< recording -> UDP in real time
void add_altitude_command(CLI::App& app);      ///< pressure logs -> heights
void add_noise_command(CLI::App& app);         ///< pressure log -> sigma, Allan deviation, filter settings
void add_compare_command(CLI::App& app);       ///< two runs or configurations
void add_report_command(CLI::App& app);        ///< a run as one page
void add_export_command(CLI::App& app);        ///< a run as MCAP
void add_foxglove_command(CLI::App& app);      ///< live topics for Foxglove
void add_map_command(CLI::App& app);           ///< info, check and export of a run's map
void add_status_command(CLI::App& app);        ///< health and figures of the running isobard
void add_metrics_command(CLI::App& app);       ///< the same for Prometheus
void add_web_command(CLI::App& app);           ///< page of the running isobard, of a run or a recording
void add_record_command(CLI::App& app);        ///< running isobard -> recording
void add_black_box_command(CLI::App& app);     ///< orders to the black box of the running isobard
void add_reset_command(CLI::App& app);         ///< asks the running isobard for a new map frame
void add_initial_pose_command(CLI::App& app);  ///< tells the running isobard where the robot is
void add_echo_command(CLI::App& app);          ///< prints what a DDS subscriber receives
void add_points_command(CLI::App& app);        ///< capture of a lidar -> points
void add_keys_command(CLI::App& app);          ///< keys that sign base-station pressure

}  // namespace isobar::tools

// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `isobar`, one file each. A subcommand adds itself to the app; its callback does the work
// and throws an isobar::Error to end with that error's exit code.
#pragma once

namespace CLI {
class App;
}

namespace isobar::tools {

void add_simulate_command(CLI::App& app);    ///< simulate.cpp: scenario -> recording
void add_replay_command(CLI::App& app);      ///< replay.cpp: recording -> trajectory, map, status
void add_evaluate_command(CLI::App& app);    ///< evaluate.cpp: reference and estimates -> figures, report
void add_experiment_command(CLI::App& app);  ///< experiment.cpp: simulate, run all methods, table, report
void add_sensitivity_command(CLI::App& experiment);  ///< sensitivity.cpp: below add_experiment_command
/// calibrate.cpp: sensor beside reference -> compensation, report
void add_calibrate_command(CLI::App& app);
void add_config_command(CLI::App& app);    ///< config.cpp: check, show
void add_play_command(CLI::App& app);      ///< play.cpp: recording -> UDP in real time
void add_altitude_command(CLI::App& app);  ///< altitude.cpp: pressures -> heights
void add_noise_command(CLI::App& app);  ///< noise.cpp: pressures -> sigma, Allan deviation, filter settings
void add_map_command(CLI::App& app);    ///< map_command.cpp: the map of a run: what is in it, as points
void add_echo_command(CLI::App& app);   ///< echo.cpp: what a DDS subscriber receives

}  // namespace isobar::tools

// SPDX-License-Identifier: BSD-3-Clause
#include "tools/command_examples.hpp"

#include <array>
#include <string>

#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

constexpr std::array kExamples{
    CommandExample{"isobar simulate", "three-floors --seed 1 --out recording"},
    CommandExample{"isobar import", "drive.bag --out recording --mount lidar=0,0,1.2,0,0,0"},
    CommandExample{"isobar check", "recording"},
    CommandExample{"isobar replay", "recording --config isobar.toml --out run"},
    CommandExample{"isobar evaluate", "recording run --report report.html"},
    CommandExample{"isobar compare", "a.toml b.toml --scenario three-floors --short"},
    CommandExample{"isobar experiment", "three-floors --seed 1"},
    CommandExample{"isobar experiment all", "--seeds 1,2,3"},
    CommandExample{"isobar experiment second-session", "three-floors"},
    CommandExample{"isobar experiment sensitivity", "--out out/sensitivity"},
    CommandExample{"isobar noise", "recording/barometer.csv --report noise.html"},
    CommandExample{"isobar altitude", "moved.csv --base standing.csv --out heights.csv"},
    CommandExample{"isobar calibrate",
                   "--sensor cold.csv warm.csv --reference station.csv --out dps310.toml"},
    CommandExample{"isobar calibrate mounts", "recording"},
    CommandExample{"isobar play", "recording --start 30 --for 60"},
    CommandExample{"isobar map info", "run"},
    CommandExample{"isobar map check", "run"},
    CommandExample{"isobar map export", "run --out map.pcd"},
    CommandExample{"isobar map floors", "run"},
    CommandExample{"isobar map grid", "run --floor 0 --out grids"},
    CommandExample{"isobar map merge", "monday tuesday --out both"},
    CommandExample{"isobar export", "run --mcap --recording recording"},
    CommandExample{"isobar report", "run"},
    CommandExample{"isobar status", "--watch"},
    CommandExample{"isobar metrics", "--listen 0.0.0.0:9464"},
    CommandExample{"isobar web", "run"},
    CommandExample{"isobar record", "recording --for 600"},
    CommandExample{"isobar blackbox save", ""},
    CommandExample{"isobar blackbox status", ""},
    CommandExample{"isobar config check", "/etc/isobar/isobar.toml"},
    CommandExample{"isobar config show", "--basic"},
    CommandExample{"isobar config seal", "isobar.toml"},
    CommandExample{"isobar config init", ""},
    CommandExample{"isobar reset", ""},
    CommandExample{"isobar initial-pose", "2.5 -1 90 --floor 0 --map run"},
    CommandExample{"isobar points", "capture.pcap --out points.ply"},
    CommandExample{"isobar keys init", "keys"},
    CommandExample{"isobar keys add", "keys robot1"},
    CommandExample{"isobar keys revoke", "keys robot1"},
    CommandExample{"isobar keys show", "keys"},
    CommandExample{"isobar echo", "pose altitude --namespace robot1"},
    CommandExample{"isobar foxglove", "--listen 0.0.0.0"},
};

}  // namespace

std::span<const CommandExample> command_examples() { return kExamples; }

void add_examples(CLI::App& app) {
  const std::string path = command_path(app);
  for (const CommandExample& example : kExamples) {
    if (path != example.command || !app.get_footer().empty()) continue;
    std::string footer = "Example:\n\n  ";
    footer += path;
    if (*example.words != '\0') footer.append(" ").append(example.words);
    app.footer(footer);
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) add_examples(*command);
}

}  // namespace isobar::tools

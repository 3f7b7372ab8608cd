// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "simulation/lidar_plan.hpp"
#include "simulation/simulate.hpp"

namespace isobar::tools {

/// Adds --lidar, the model whose packets a simulated robot records. simulation::simulate() refuses unknown names.
inline void add_lidar_option(CLI::App& command, simulation::ScenarioRequest& request) {
  std::string names;
  for (const simulation::LidarPlan& plan : simulation::lidar_plans()) {
    names += (names.empty() ? "" : ", ") + std::string(plan.name);
  }
  command.add_option("--lidar", request.lidar, "model of the robot's lidar: " + names)->capture_default_str();
}

}  // namespace isobar::tools

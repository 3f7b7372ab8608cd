// SPDX-License-Identifier: BSD-3-Clause
// What a live run does about contradictions of its sensors.
#pragma once

#include <vector>

#include "config/config.hpp"
#include "core/contradictions/finding.hpp"
#include "ipc/topics.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

/// `config` without the sensors that contradict it.
Config without_unusable(Config config, const UsableSensors& usable);

/// Adds an error "imu/contradiction", "wheels/contradiction" … for each sensor with a finding: the sentence with the remedy.
/// The log has it once, as every change of a level.
void add_contradictions(ipc::HealthReport& report, const Findings& findings);

/// Adds the findings to the counters of the run.
void add_contradictions(std::vector<files::RunCount>& counts, const Findings& findings);

}  // namespace isobar

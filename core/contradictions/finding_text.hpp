// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/contradictions/finding.hpp"

namespace isobar {

/// One sentence with the remedy: "gravity points up: imu.rpy_deg = [180, 0, 0] would fit". It fits into a health entry.
std::string finding_text(const Finding& finding);

/// What the run does about it: "the IMU is not used"; empty where it uses everything.
std::string left_out_text(const UsableSensors& usable);

/// Difference of two clocks: "18.0 s", "8 h 0 min 2 s".
std::string clock_difference_text(double difference_s);

}  // namespace isobar

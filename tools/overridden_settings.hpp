// SPDX-License-Identifier: BSD-3-Clause
// Settings of a file that a recording replaces by its own.
#pragma once

#include <string>
#include <vector>

#include "config/config_layer.hpp"

namespace isobar::tools {

/// Keys that the files of `loaded` set and `used` has otherwise, one sentence each:
/// "robot.toml:12: lidar.model = "VLP-16" is not used: the recording has "XT16"".
std::vector<std::string> overridden_settings(const LoadedConfig& loaded, const Config& used);

}  // namespace isobar::tools

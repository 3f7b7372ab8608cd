// SPDX-License-Identifier: BSD-3-Clause
// A configuration as pairs of key and value.
#pragma once

#include <map>
#include <string>

#include "config/config.hpp"

namespace isobar {

/// Every setting that the configuration's role uses, "lidar.port" → "2368", values as TOML writes them.
std::map<std::string, std::string> settings_by_key(const Config& config);

}  // namespace isobar

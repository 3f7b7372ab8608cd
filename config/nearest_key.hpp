// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "config/setting.hpp"

namespace isobar {

/// The key of the table that an unknown key probably means, by edit distance; empty if none is close.
std::string nearest_key(const std::vector<Setting>& settings, const std::string& key);

}  // namespace isobar

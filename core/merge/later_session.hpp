// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "core/map/map_config.hpp"

namespace isobar {

/// Settings with which the scans of a later session are laid into the map of an earlier one. Live, a surface counts as gone
/// where rays end 0.35 m behind it, since pose and map may be off by decimetres on a way back; poses of a graph agree to
/// centimetres. 0.2 m clears furniture that stood at a wall.
[[nodiscard]] inline MapConfig of_later_session(MapConfig config) {
  config.see_through_margin_m = std::min(config.see_through_margin_m, 0.2);
  return config;
}

}  // namespace isobar

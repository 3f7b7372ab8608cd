// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/floor_health.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace isobar::bridge {

void add_floor_health(const FloorState& state, const AddEntry& add) {
  if (!state.heard) return;
  const ipc::CurrentFloor& floor = state.floor;
  const std::string name(floor.name, strnlen(floor.name, sizeof(floor.name)));
  const std::string which = std::to_string(floor.number) + (name.empty() ? "" : " (" + name + ")");
  const double certainty = std::isfinite(floor.certainty) ? std::clamp(floor.certainty, 0.0, 1.0) : 0.0;
  const std::string percent = std::to_string(static_cast<int>(100.0 * certainty));
  const std::string text = !floor.known && !std::isfinite(floor.z_m) ? "none known yet"
                           : floor.known
                               ? which + ", certain to " + percent + " %"
                               : std::string(kFloorPlaceTexts.name(floor.place)) + "; last: " + which;
  add("floor", ipc::HealthLevel::kOk, text, floor.number);
}

}  // namespace isobar::bridge

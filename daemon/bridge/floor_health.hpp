// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/base_station_health.hpp"
#include "daemon/bridge/floor_forwarding.hpp"

namespace isobar::bridge {

/// The floor that the robot is on, with its certainty. Nothing before the first message about it.
void add_floor_health(const FloorState& state, const AddEntry& add);

}  // namespace isobar::bridge

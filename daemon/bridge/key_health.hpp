// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/base_station_health.hpp"
#include "daemon/bridge/station_keys.hpp"

namespace isobar::bridge {

/// Diagnostics of the keys: bridge/keys, and what they keep out: bridge/keys/unsigned, bridge/keys/refused.
void add_key_health(const KeyStatus& status, const AddEntry& add);

}  // namespace isobar::bridge

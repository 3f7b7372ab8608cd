// SPDX-License-Identifier: BSD-3-Clause
// What a base station's stream says of itself, in sentences; the same for both ways in.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/time/base_station_stream.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Takes one line of health: name, level, message, value.
using AddEntry = std::function<void(const std::string&, ipc::HealthLevel, const std::string&, double)>;

/// One line `name`: is it there, how often does it send, is it alone.
/// @param now_ns robot clock
/// @param where it is listened for
void add_base_station_state(const std::string& name, const BaseStationStatus& status, std::int64_t now_ns,
                            const std::string& where, const AddEntry& add);

/// A line `name`/… for everything that was refused or happened at least once; a warning while it goes on.
/// @param before the status of the call before
void add_base_station_counts(const std::string& name, const BaseStationStatus& now,
                             const BaseStationStatus& before, const AddEntry& add);

}  // namespace isobar

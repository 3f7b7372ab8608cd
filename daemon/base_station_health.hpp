// SPDX-License-Identifier: BSD-3-Clause
// Health entries of a base station's stream; the same for UDP (isobard) and DDS (isobar-dds).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/time/base_station_stream.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Adds one entry: name, level, message, value.
using AddEntry = std::function<void(const std::string&, ipc::HealthLevel, const std::string&, double)>;

/// Adds the entry `name`: state, rate and clock offset of the base station, or a second one with its name.
/// @param now_ns robot clock
/// @param where the input that receives it, such as a topic
/// @param expected false: one that was never heard is ok, as "none": it may use another input, or not exist
void add_base_station_state(const std::string& name, const BaseStationStatus& status, std::int64_t now_ns,
                            const std::string& where, const AddEntry& add, bool expected = true);

/// Adds an entry `name`/… for each counter above zero, a warning while it grows.
/// @param before the status at the last call
void add_base_station_counts(const std::string& name, const BaseStationStatus& now,
                             const BaseStationStatus& before, const AddEntry& add);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Which base station the heights of a stored map refer to.
#pragma once

#include <string>

#include "config/config.hpp"
#include "run/files/checkpoint.hpp"

namespace isobar {

/// Names of the base stations that a robot listens to: dds.base_station and dds.second_base_station.
[[nodiscard]] files::StationNames station_names(const Config& config);

/// Lets the datum of a checkpoint go on with the base stations of this run, whichever of them is the first: offsets follow the
/// names. If it knows none of them, its heights mean nothing here: the datum is forgotten. A checkpoint without names is
/// believed.
/// @param names of this run, station_names()
/// @return a sentence that names both; empty: the heights go on
[[nodiscard]] std::string take_over_stations(files::Checkpoint& checkpoint, const files::StationNames& names);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Counters of the stages by name, for counters.csv, the health report and the summary of a replay.
#pragma once

#include <string>
#include <vector>

#include "core/prior/prior_estimator.hpp"
#include "core/time/base_station_stream.hpp"
#include "drivers/barometer/barometer_device.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/velodyne/velodyne_decoder.hpp"
#include "run/files/run_output.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

std::vector<files::RunCount> counts_of(const velodyne::VelodyneCounters& counters,
                                       const std::string& wrong_model_message);
std::vector<files::RunCount> counts_of(const PriorCounters& counters);
std::vector<files::RunCount> counts_of(const datagram::Counters& counters);
/// Of the base station that sends datagrams.
std::vector<files::RunCount> counts_of(const BaseStationStatus& base);
std::vector<files::RunCount> counts_of(const BarometerCounters& counters);

/// Writes map.ply and counts what became of the map on the disk, during the run and then.
std::vector<files::RunCount> counts_of_map(FileTileStore& store, files::RunOutput& output);

/// Appends `more` to `counts`.
void append(std::vector<files::RunCount>& counts, std::vector<files::RunCount> more);

}  // namespace isobar

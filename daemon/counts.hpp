// SPDX-License-Identifier: BSD-3-Clause
// Counters of the stages by name, for counters.csv and the summary of a replay.
#pragma once

#include <string>
#include <vector>

#include "core/loops/building.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/time/base_station_stream.hpp"
#include "drivers/datagram/datagram.hpp"
#include "drivers/device/device.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "run/files/run_output.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

std::vector<files::RunCount> counts_of(const LidarCounters& counters, const std::string& wrong_model_message);
std::vector<files::RunCount> counts_of(const PriorCounters& counters);
std::vector<files::RunCount> counts_of(const BuildingCounts& counts);
std::vector<files::RunCount> counts_of(const datagram::Counters& counters);
/// Counters of the base station that sends datagrams.
std::vector<files::RunCount> counts_of(const BaseStationStatus& base);
std::vector<files::RunCount> counts_of(const DeviceCounters& counters);

/// Writes map.ply; returns the counters of the tile store, during the run and while writing.
std::vector<files::RunCount> counts_of_map(FileTileStore& store, files::RunOutput& output);

namespace run_counts {
/// Moves the elements of `more` to the end of `counts`.
void append(std::vector<files::RunCount>& counts, std::vector<files::RunCount> more);
}  // namespace run_counts

}  // namespace isobar

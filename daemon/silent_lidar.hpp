// SPDX-License-Identifier: BSD-3-Clause
// Why a capture gave no scan: what was found in it instead.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar {

/// Whether packets came that were or should have been data.
[[nodiscard]] bool has_data_packets(const LidarCounters& lidar);

/// "position packets only (100), no data packet: is the laser off?" for a lidar that sends its other packets; empty where
/// nothing tells that: none came, or another port is as busy, which may be its data.
/// @param info_port of its other packets
/// @param ports packets for ports that nobody wanted
/// @param without_points packets that the decoder took, without points
[[nodiscard]] std::string only_information_text(const LidarModel& model, std::uint16_t info_port,
                                                const recording::PortsSeen& ports,
                                                std::uint64_t without_points);

/// A sentence without its full stop, after a reader has read to the end: the packets' model, the ports seen, the damage of
/// the file.
[[nodiscard]] std::string silent_lidar_text(const recording::RecordingReader& reader,
                                            const ScanAssembler& assembler);

}  // namespace isobar

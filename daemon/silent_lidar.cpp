// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/silent_lidar.hpp"

#include <algorithm>

namespace isobar {

namespace {

/// Counters of the lidar packets with what they found, in one line.
std::string refusals(const std::vector<recording::Count>& counts) {
  std::string text;
  for (const recording::Count& count : counts) {
    if (count.name.rfind("lidar", 0) != 0 || count.count == 0) continue;
    text += (text.empty() ? "" : "; ") + count.name + ": " + std::to_string(count.count);
    if (!count.first_message.empty()) text += " (" + count.first_message + ")";
  }
  return text.empty() ? "the file contains no packets" : text;
}

}  // namespace

bool has_data_packets(const LidarCounters& lidar) {
  return lidar.packets + lidar.wrong_model + lidar.garbage + lidar.truncated + lidar.oversized > 0;
}

std::string only_information_text(const LidarModel& model, std::uint16_t info_port,
                                  const recording::PortsSeen& ports, std::uint64_t without_points) {
  const std::uint64_t unwanted = info_port == 0 ? 0 : ports.count(info_port);
  const std::uint64_t packets = std::max(without_points, unwanted);
  if (packets <= ports.most_but(info_port)) return {};
  const char* what = model.maker == "Velodyne" ? "position packets" : "packets of device information or IMU";
  return std::string(what) + " only (" + std::to_string(packets) + "), no data packet: is the laser off?";
}

std::string silent_lidar_text(const recording::RecordingReader& reader, const ScanAssembler& assembler) {
  const LidarCounters& lidar = assembler.counters();
  std::string text;
  if (lidar.wrong_model > 0) text += assembler.decoder().mismatch() + "; ";
  const LidarModel* model = find_lidar_model(assembler.decoder().model());
  if (model != nullptr && !has_data_packets(lidar)) {
    const auto& named = reader.manifest().lidar;
    const std::uint16_t info_port = named && named->info_port != 0 ? named->info_port : model->info_port;
    const std::string only = only_information_text(*model, info_port, reader.other_ports(), lidar.no_points);
    if (!only.empty()) text += only + " ";
  }
  return text + refusals(reader.counts());
}

}  // namespace isobar

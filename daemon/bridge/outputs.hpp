// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/bridge/settings.hpp"
#include "ipc/dds/outputs.hpp"

namespace isobar::bridge {

/// All DDS writers of this machine: pose and clouds on a robot, pressure on a base station, diagnostics on
/// both.
struct Outputs {
  dds::Writer<dds::DiagnosticsMessage> diagnostics;
  std::optional<dds::PoseOutputs> poses;       ///< robot only
  std::optional<dds::CloudOutputs> clouds;     ///< robot only, with dds.publish_clouds
  std::optional<dds::StationOutputs> station;  ///< base station only

  /// @throws ServiceError when a DDS entity cannot be created
  Outputs(dds_entity_t participant, const Settings& settings)
      : diagnostics(participant, dds::topics::kDiagnostics) {
    if (settings.is_base_station) {
      station.emplace(participant, settings.dds.base_station);
      return;
    }
    poses.emplace(participant, settings.dds, settings.mounts);
    if (settings.dds.publish_clouds) clouds.emplace(participant, settings.dds);
  }

  [[nodiscard]] std::vector<dds_entity_t> writers() const {
    std::vector<dds_entity_t> writers{diagnostics.get()};
    const auto append = [&writers](const auto& outputs) {
      if (!outputs) return;
      for (const dds_entity_t writer : outputs->writers()) writers.push_back(writer);
    };
    append(poses);
    append(clouds);
    append(station);
    return writers;
  }
};

}  // namespace isobar::bridge

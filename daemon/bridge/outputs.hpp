// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/bridge/settings.hpp"
#include "ipc/dds/outputs.hpp"

namespace isobar::bridge {

/// Everything that this machine says over DDS: a robot where it is, a base station its pressure, both how
/// they are.
struct Outputs {
  dds::Writer<dds::DiagnosticsMessage> diagnostics;
  std::optional<dds::PoseOutputs> poses;       ///< a robot's
  std::optional<dds::CloudOutputs> clouds;     ///< a robot's, where they are wanted
  std::optional<dds::StationOutputs> station;  ///< a base station's

  /// @throws ServiceError DDS refuses
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

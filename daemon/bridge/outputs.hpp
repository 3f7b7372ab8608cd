// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/bridge/settings.hpp"
#include "ipc/dds/floor_outputs.hpp"
#include "ipc/dds/outputs.hpp"

namespace isobar::bridge {

/// Whether scans and maps are published with these settings.
[[nodiscard]] inline bool publishes_clouds(const Settings& settings) {
  return !settings.is_base_station && settings.dds.publish_clouds;
}

/// All DDS outputs of this machine: pose, clouds and floors on a robot, pressure on a base station, diagnostics on
/// both.
struct Outputs {
  std::optional<dds::Writer<dds::DiagnosticsMessage>> diagnostics;  ///< while open
  std::optional<dds::PoseOutputs> poses;                            ///< robot only
  std::optional<dds::CloudOutputs> clouds;                          ///< robot only, with dds.publish_clouds
  std::optional<dds::FloorOutputs> floors;                          ///< robot only
  std::optional<dds::StationOutputs> station;                       ///< base station only

  explicit Outputs(const Settings& settings) { configure(settings); }

  /// Takes other settings while closed. What is still published keeps what it has gathered.
  void configure(const Settings& settings) {
    diagnostics_name_ = settings.dds.topics.diagnostics;
    configure(station, settings.is_base_station, settings.dds);
    configure(poses, !settings.is_base_station, settings.dds, settings.mounts);
    configure(clouds, publishes_clouds(settings), settings.dds);
    configure(floors, !settings.is_base_station, settings.dds);
  }

  /// @param for_station participant of the base station's topics; 0: these stay closed
  /// @throws ServiceError when a DDS entity cannot be created
  void open(dds_entity_t participant, dds_entity_t for_station) {
    diagnostics.emplace(participant, dds::topics::kDiagnostics, "", diagnostics_name_);
    if (poses) poses->open(participant);
    if (clouds) clouds->open(participant);
    if (floors) floors->open(participant);
    if (station && for_station != 0) station->open(for_station);
  }
  void close() noexcept {
    diagnostics.reset();
    if (poses) poses->close();
    if (clouds) clouds->close();
    if (floors) floors->close();
    if (station) station->close();
  }

  [[nodiscard]] std::vector<dds_entity_t> writers() const {
    std::vector<dds_entity_t> writers;
    if (diagnostics) writers.push_back(diagnostics->get());
    const auto append = [&writers](const auto& outputs) {
      if (!outputs) return;
      for (const dds_entity_t writer : outputs->writers()) writers.push_back(writer);
    };
    append(poses);
    append(clouds);
    append(floors);
    append(station);
    return writers;
  }

 private:
  template <class Output, class... Settings>
  static void configure(std::optional<Output>& output, bool is_wanted, const Settings&... settings) {
    if (!is_wanted) {
      output.reset();
    } else if (output) {
      output->configure(settings...);
    } else {
      output.emplace(settings...);
    }
  }
  std::string diagnostics_name_;
};

}  // namespace isobar::bridge

// SPDX-License-Identifier: BSD-3-Clause
// What a recording says about the isobard that ran: sensors, mounts, settings.
#pragma once

#include <string>

#include "config/config.hpp"
#include "ipc/shared_memory.hpp"
#include "run/recording/manifest.hpp"

namespace isobar {

/// Manifest of a recording of this configuration's inputs: every sensor that may deliver.
[[nodiscard]] recording::Manifest manifest_of(const Config& config);

/// Settings in force, without comments: the settings.toml of a recording.
[[nodiscard]] std::string settings_in_force(const Config& config);

/// Publishes the description of the running isobard. Belongs to one thread; must live as long as recorders
/// are to find it.
class RunDescriptionPublisher {
 public:
  explicit RunDescriptionPublisher(const Config& config);
  /// Replaces the description: after a change of the configuration.
  void publish(const Config& config);

 private:
  ipc::Publisher<ipc::RunDescription> publisher_;
};

}  // namespace isobar

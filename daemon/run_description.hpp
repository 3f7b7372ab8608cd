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

/// Publishes the description of the running isobard, for recorders and for isobar-dds. Belongs to one thread;
/// must live as long as they are to find it.
class RunDescriptionPublisher {
 public:
  /// @param configuration config_identity() of the configuration's main file; empty: defaults
  RunDescriptionPublisher(const Config& config, std::string configuration);
  /// Replaces the description: after a change of the configuration.
  void publish(const Config& config);

 private:
  std::string configuration_;
  ipc::Publisher<ipc::RunDescription> publisher_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// The environment variables of ROS 2 and Cyclone DDS that isobar-dds follows, as ROS 2 nodes do.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ipc/dds_config.hpp"

namespace isobar::bridge {

/// Value of an environment variable; empty where it is not set.
using ReadVariable = std::function<std::string(const char* name)>;
[[nodiscard]] std::string read_environment(const char* name);

/// What the environment has changed.
struct Environment {
  std::string uri;                    ///< CYCLONEDDS_URI
  bool uri_names_interfaces = false;  ///< then dds.network_interface is not used
  std::vector<std::string> notes;     ///< for the log, one sentence each
};

/// Applies ROS_DOMAIN_ID where the configuration leaves the domain open (-1, which becomes 0 without the
/// variable), ROS_LOCALHOST_ONLY=1 or ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST (loopback only), and
/// ROS_STATIC_PEERS (IPv4 addresses, beside dds.peers).
/// @throws ConfigError when ROS_DOMAIN_ID is no domain
[[nodiscard]] Environment apply_environment(dds::DdsConfig& config, const ReadVariable& read);

}  // namespace isobar::bridge

// SPDX-License-Identifier: BSD-3-Clause
// The one way in which subcommands join DDS.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "ipc/dds/participant.hpp"

namespace isobar::tools {

struct DdsOptions {
  int domain = 0;
  std::string network_interface;  ///< names or addresses, separated by commas; empty: all
  std::string ros_namespace;      ///< of the robot or base station; may be empty
};

/// Adds --domain, --interface and --namespace.
/// @param when ends each of their descriptions, " (with --mcap)"
void add_dds_options(CLI::App& command, DdsOptions& options, const std::string& when = {});

/// @throws ServiceError when an interface that was asked for is not up, or DDS fails
[[nodiscard]] dds::Participant join_dds(const DdsOptions& options);

}  // namespace isobar::tools

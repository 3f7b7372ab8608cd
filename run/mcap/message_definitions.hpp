// SPDX-License-Identifier: BSD-3-Clause
// Definitions of the ROS 2 messages that Isobar writes, as MCAP and Foxglove want them: with those of all parts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace isobar::mcap {

/// The text of encoding "ros2msg": the type's members, then each part's behind a line of '=' and its name.
/// @param type "nav_msgs/msg/Odometry"
/// @throws UsageError for a type that is not in the table
std::string message_definition(std::string_view type);

/// All types of the table.
std::vector<std::string> message_types();

}  // namespace isobar::mcap

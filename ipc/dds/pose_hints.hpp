// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ipc/dds/topics.hpp"
#include "ipc/pose_hint.hpp"

namespace isobar::dds {

/// Hint in a message, as RViz's "2D Pose Estimate" sends it. Its frame is a map frame (frame_of_session()), or empty:
/// the one in force. z counts only where a variance of z is stated: a click on a plane says nothing of the height. The
/// time stamp is ignored: a person says where the robot is as of now.
/// @param map_frame name of the first map frame
/// @return nullptr, or the rule that the message breaks; `hint` is then unchanged
[[nodiscard]] const char* to_hint(const PoseMessage& message, const std::string& map_frame,
                                  ipc::PoseHint& hint) noexcept;

}  // namespace isobar::dds

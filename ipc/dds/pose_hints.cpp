// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/pose_hints.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>

namespace isobar::dds {
namespace {

/// Largest departure of a quaternion's norm from 1: tools send floats, people type three digits.
constexpr double kNormTolerance = 1e-2;

/// Number of the map frame of this name; 0: the one in force; nothing: no map frame.
std::optional<std::uint32_t> session_of(std::string_view frame, std::string_view map_frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);  // as tf of ROS 1 wrote it
  if (frame.empty()) return 0;
  if (frame == map_frame) return 1;
  if (!frame.starts_with(map_frame)) return std::nullopt;
  frame.remove_prefix(map_frame.size());
  if (!frame.starts_with('_')) return std::nullopt;
  frame.remove_prefix(1);
  std::uint32_t session = 0;
  const auto [end, error] = std::from_chars(frame.data(), frame.data() + frame.size(), session);
  const bool is_number = error == std::errc{} && end == frame.data() + frame.size() && session > 1;
  return is_number ? std::optional(session) : std::nullopt;
}

}  // namespace

const char* to_hint(const PoseMessage& message, const std::string& map_frame, ipc::PoseHint& hint) noexcept {
  const char* frame = message.header.frame_id;
  const auto session = session_of(frame != nullptr ? frame : "", map_frame);
  if (!session) return "its frame must be the map's, or empty";
  const auto& q = message.pose.pose.orientation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1.0) <= kNormTolerance)) return "its orientation must be a unit quaternion";
  constexpr std::size_t kVarianceOfZ = 14;
  ipc::PoseHint candidate;
  candidate.source = ipc::PoseHintSource::kDds;
  candidate.session = *session;
  candidate.x_m = message.pose.pose.position.x;
  candidate.y_m = message.pose.pose.position.y;
  candidate.z_m = message.pose.pose.position.z;
  candidate.has_z = message.pose.covariance[kVarianceOfZ] > 0.0;
  candidate.yaw_rad = std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
  std::copy(std::begin(message.pose.covariance), std::end(message.pose.covariance),
            candidate.covariance.begin());
  if (const char* broken = ipc::implausibility(candidate); broken != nullptr) return broken;
  hint = candidate;
  return nullptr;
}

}  // namespace isobar::dds

// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/frame_tree.hpp"

#include <algorithm>

namespace isobar::imports {
namespace {

constexpr std::size_t kMostFrames = 10'000;
/// Longest chain of frames; damaged or foreign data may hold a ring.
constexpr std::size_t kLongestChain = 64;

/// tf of ROS 1 allows "/base_link".
std::string plain_frame(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

}  // namespace

void FrameTree::add(const std::vector<StampedPose>& transforms) {
  for (const StampedPose& transform : transforms) {
    if (parents_.size() >= kMostFrames) return;
    parents_.try_emplace(plain_frame(transform.child),
                         Parent{plain_frame(transform.header.frame_id), transform.pose});
  }
}

bool FrameTree::holds(const std::string& frame) const {
  const std::string name = plain_frame(frame);
  return parents_.contains(name) || std::any_of(parents_.begin(), parents_.end(),
                                                [&](const auto& entry) { return entry.second.name == name; });
}

std::vector<std::pair<std::string, Eigen::Isometry3d>> FrameTree::ancestors(const std::string& start) const {
  std::vector<std::pair<std::string, Eigen::Isometry3d>> chain{
      {plain_frame(start), Eigen::Isometry3d::Identity()}};
  while (chain.size() < kLongestChain) {
    const auto parent = parents_.find(chain.back().first);
    if (parent == parents_.end()) break;
    chain.emplace_back(parent->second.name, parent->second.T_parent_child * chain.back().second);
  }
  return chain;
}

std::optional<Eigen::Isometry3d> FrameTree::find(const std::string& base, const std::string& frame) const {
  const auto of_frame = ancestors(frame);
  for (const auto& [name, T_ancestor_base] : ancestors(base)) {
    for (const auto& [other, T_ancestor_frame] : of_frame) {
      if (name == other) return T_ancestor_base.inverse() * T_ancestor_frame;
    }
  }
  return std::nullopt;
}

}  // namespace isobar::imports

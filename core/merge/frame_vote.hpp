// SPDX-License-Identifier: BSD-3-Clause
// Where one map lies in another, from several places that were searched one by one: one place may look like another, three
// places that agree seldom do.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace isobar {

/// What one search says of the frame of map B in that of map A.
struct FrameHypothesis {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< about z
  double weight = 0.0;  ///< probability among those of its search, 0 … 1
};

/// Result of one search.
struct PlaceVote {
  Eigen::Vector3d p_b = Eigen::Vector3d::Zero();  ///< the place [m]
  std::vector<FrameHypothesis> hypotheses;        ///< none: not found
};

/// A hypothesis of a vote.
struct ChosenHypothesis {
  std::size_t vote = 0;
  std::size_t hypothesis = 0;
};

/// Result of all searches.
struct FrameVerdict {
  std::size_t located = 0;                 ///< searches with a hypothesis
  std::vector<ChosenHypothesis> agreeing;  ///< with the best frame, one a place: of different places
  double support = 0.0;                    ///< sum of their weights
  double rival = 0.0;                      ///< the same of the best frame that contradicts it
  std::optional<Eigen::Isometry3d> T_a_b;  ///< where it is certain
};

/// Places nearer to each other than this are one [m].
inline constexpr double kOnePlaceM = 3.0;
/// Places that must agree.
inline constexpr std::size_t kLeastAgreeing = 3;

/// The frame on which most places agree: at least kLeastAgreeing, and twice as many as on any other. Frames agree where they
/// put both places within 0.5 m and 2 % of the way between them, which B may have drifted, and turn them within 3 degrees.
[[nodiscard]] FrameVerdict common_frame(std::span<const PlaceVote> votes);

}  // namespace isobar

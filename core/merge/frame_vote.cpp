// SPDX-License-Identifier: BSD-3-Clause
#include "core/merge/frame_vote.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "core/so3.hpp"

namespace isobar {
namespace {

constexpr double kApartM = 0.5;
constexpr double kApartShare = 0.02;
constexpr double kTurned = 3.0 * kRadPerDeg;
// Sum of weights below which the searches were all in doubt.
constexpr double kLeastSupport = 1.5;
// Of the support of the best frame, that of one that contradicts it.
constexpr double kMostRival = 0.5;

bool agree(const Eigen::Isometry3d& T, const Eigen::Vector3d& p, const Eigen::Isometry3d& T_other,
           const Eigen::Vector3d& p_other) {
  const double most_m = kApartM + kApartShare * (p - p_other).norm();
  const double turned = std::abs(yaw_of(T.linear() * T_other.linear().transpose()));
  return turned < kTurned && (T * p - T_other * p).norm() < most_m &&
         (T * p_other - T_other * p_other).norm() < most_m;
}

struct Support {
  std::vector<ChosenHypothesis> agreeing;
  double weight = 0.0;
};

// Places that agree with a frame; of two that are one place, the first.
Support support_of(const FrameHypothesis& frame, const Eigen::Vector3d& p, std::span<const PlaceVote> votes) {
  Support support;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    const PlaceVote& vote = votes[i];
    const bool known =
        std::any_of(support.agreeing.begin(), support.agreeing.end(), [&](const ChosenHypothesis& other) {
          return (votes[other.vote].p_b - vote.p_b).norm() < kOnePlaceM;
        });
    if (known) continue;
    std::optional<std::size_t> best;
    for (std::size_t k = 0; k < vote.hypotheses.size(); ++k) {
      if (!agree(frame.T_a_b, p, vote.hypotheses[k].T_a_b, vote.p_b)) continue;
      if (!best || vote.hypotheses[k].weight > vote.hypotheses[*best].weight) best = k;
    }
    if (!best) continue;
    support.agreeing.push_back({i, *best});
    support.weight += vote.hypotheses[*best].weight;
  }
  return support;
}

}  // namespace

FrameVerdict common_frame(std::span<const PlaceVote> votes) {
  struct Tried {
    const PlaceVote* vote;
    const FrameHypothesis* frame;
    Support support;
  };
  FrameVerdict verdict;
  std::vector<Tried> tried;
  for (const PlaceVote& vote : votes) {
    verdict.located += vote.hypotheses.empty() ? 0 : 1;
    for (const FrameHypothesis& frame : vote.hypotheses) {
      tried.push_back({&vote, &frame, support_of(frame, vote.p_b, votes)});
    }
  }
  if (tried.empty()) return verdict;
  const Tried& best = *std::max_element(tried.begin(), tried.end(), [](const Tried& a, const Tried& b) {
    return a.support.weight < b.support.weight;
  });
  for (const Tried& other : tried) {
    if (agree(best.frame->T_a_b, best.vote->p_b, other.frame->T_a_b, other.vote->p_b)) continue;
    verdict.rival = std::max(verdict.rival, other.support.weight);
  }
  verdict.agreeing = best.support.agreeing;
  verdict.support = best.support.weight;
  if (verdict.agreeing.size() >= kLeastAgreeing && verdict.support >= kLeastSupport &&
      verdict.rival <= kMostRival * verdict.support) {
    verdict.T_a_b = best.frame->T_a_b;
  }
  return verdict;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/loops/loop_evidence.hpp"

#include <Eigen/Cholesky>

namespace isobar {
namespace {

// Largest squared distance of two right loops by their covariances: probability 1e-3, 4 degrees of freedom.
constexpr double kGate = 18.5;

bool agree(const LoopEvidence& a, const LoopEvidence& b) {
  const Eigen::Vector4d difference = a.shift - b.shift;
  const Eigen::Matrix4d covariance = a.covariance + b.covariance;
  return difference.dot(covariance.ldlt().solve(difference)) < kGate;
}

}  // namespace

std::vector<Loop> LoopPairs::add(const LoopEvidence& evidence) {
  std::erase_if(waiting_, [&](const Waiting& other) {
    return evidence.loop.way_m - other.evidence.loop.way_m > kMostWayM;
  });
  std::vector<Loop> accepted;
  bool confirmed = false;
  for (Waiting& other : waiting_) {
    const double way_m = evidence.loop.way_m - other.evidence.loop.way_m;
    if (way_m < kLeastWayM || !agree(evidence, other.evidence)) continue;
    confirmed = true;
    if (!other.accepted) accepted.push_back(other.evidence.loop);
    other.accepted = true;
  }
  if (confirmed) accepted.push_back(evidence.loop);
  waiting_.push_back({evidence, confirmed});
  return accepted;
}

}  // namespace isobar

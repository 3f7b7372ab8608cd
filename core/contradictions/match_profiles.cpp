// SPDX-License-Identifier: BSD-3-Clause
// Point-to-line registration of two horizontal slices.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/contradictions/scan_motion.hpp"
#include "core/geometry.hpp"

namespace isobar {

namespace {

constexpr int kTurnBins = static_cast<int>(ScanProfile::kBins);
constexpr float kBinRad = static_cast<float>(2.0 * kPi / kTurnBins);
// 30 deg a scan either way: 5 rad/s at 10 Hz.
constexpr int kTurnSearchBins = 60;
constexpr int kNeighbours = 5;
constexpr int kLeastMatches = 80;
constexpr int kIterations = 20;
// Pairs farther apart are cut in the search: doors, people, corners.
constexpr float kSearchCutM = 1.0F;
// Share of pairs that fit in the end. Two different rooms agree in a third.
constexpr double kLeastFit = 0.6;
// Smallest mean squared share of a direction in the normals: a wall across in a sixteenth of the view.
constexpr double kLeastWayInformation = 0.06;
// Smallest information about the turn with the way left free [m^2]: a round room has none.
constexpr double kLeastTurnInformationM2 = 0.02;

std::size_t wrapped(int bin) { return static_cast<std::size_t>((bin % kTurnBins + kTurnBins) % kTurnBins); }

/// Turn that brings the ranges together, without any way.
int search_turn(const ScanProfile& before, const ScanProfile& after) {
  // Ranges with their ends repeated, so that no index of the inner loop wraps; negative: none.
  constexpr std::size_t kRanges = std::size_t{2} * kTurnSearchBins + ScanProfile::kBins;
  std::array<float, kRanges> ranges_m{};
  for (int i = 0; i < static_cast<int>(ranges_m.size()); ++i) {
    const ScanProfile::Bin& bin = before.bins[wrapped(i - kTurnSearchBins)];
    ranges_m[static_cast<std::size_t>(i)] = bin.valid ? bin.range_m : -1.0F;
  }
  int best = 0;
  float best_cost = 1e9F;
  for (int shift = -kTurnSearchBins; shift <= kTurnSearchBins; ++shift) {
    float sum = 0.0F;
    int pairs = 0;
    const float* const shifted_m = ranges_m.data() + kTurnSearchBins + shift;
    for (std::size_t i = 0; i < ScanProfile::kBins; ++i) {
      if (shifted_m[i] < 0.0F || !after.bins[i].valid) continue;
      sum += std::min(std::abs(shifted_m[i] - after.bins[i].range_m), kSearchCutM);
      ++pairs;
    }
    if (pairs < kLeastMatches) continue;
    // The smaller turn of two that fit alike.
    const float cost = sum / static_cast<float>(pairs) + 1e-5F * static_cast<float>(std::abs(shift));
    if (cost < best_cost) {
      best_cost = cost;
      best = shift;
    }
  }
  return best;
}

/// Normal equations of one iteration; unknowns: turn, x, y.
struct Normal {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  Eigen::Matrix3d fit_H = Eigen::Matrix3d::Zero();  // of the pairs that fit
  int pairs = 0;
  int fits = 0;
};

Normal normal_equations(const ScanProfile& before, const ScanProfile& after, const Eigen::Vector3d& motion,
                        double gate_m) {
  Normal sum;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(motion[0]).toRotationMatrix();
  for (const ScanProfile::Bin& from : after.bins) {
    if (!from.valid) continue;
    const Eigen::Vector2d turned = R * from.p_m.cast<double>();
    const Eigen::Vector2d p = turned + motion.tail<2>();
    const int bin = static_cast<int>(
        std::floor(std::atan2(static_cast<float>(p.y()), static_cast<float>(p.x())) / kBinRad));
    const ScanProfile::Bin& to = before.bins[wrapped(bin)];
    if (!to.valid || !to.has_line) continue;
    const Eigen::Vector2d n = to.normal.cast<double>();
    const double error_m = n.dot(p - to.centre_m.cast<double>());
    const double fit_m = 0.05 + 0.005 * static_cast<double>(to.range_m);
    ++sum.pairs;
    if (std::abs(error_m) > std::max(gate_m, 2.0 * fit_m)) continue;
    const Eigen::Vector3d J(n.y() * turned.x() - n.x() * turned.y(), n.x(), n.y());
    const double weight = std::abs(error_m) <= fit_m ? 1.0 : fit_m / std::abs(error_m);
    sum.H += weight * J * J.transpose();
    sum.g += weight * error_m * J;
    if (std::abs(error_m) > fit_m) continue;
    sum.fit_H += J * J.transpose();
    ++sum.fits;
  }
  return sum;
}

void judge(const Normal& last, ScanStep& step) {
  if (last.pairs < kLeastMatches || last.fits < kLeastFit * last.pairs) return;
  const Eigen::Matrix3d H = last.fit_H / last.fits;
  const Eigen::Matrix2d way = H.bottomRightCorner<2, 2>();
  const Eigen::Matrix2d damped = way + 1e-3 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d cross = H.col(0).tail<2>();
  const double turn_information = H(0, 0) - cross.dot(damped.inverse() * cross);
  step.turn_known = turn_information >= kLeastTurnInformationM2;
  const double half_trace = 0.5 * way.trace();
  const double least = half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - way.determinant()));
  step.way_known = step.turn_known && least >= kLeastWayInformation;
}

}  // namespace

void fit_lines(ScanProfile& profile) {
  for (int i = 0; i < kTurnBins; ++i) {
    ScanProfile::Bin& bin = profile.bins[static_cast<std::size_t>(i)];
    if (!bin.valid) continue;
    // Neighbours on the same surface: no step in range by more than a wall at 10 deg makes.
    Eigen::Vector2f mean = Eigen::Vector2f::Zero();
    Eigen::Matrix2f moment = Eigen::Matrix2f::Zero();
    int count = 0;
    for (int k = -kNeighbours; k <= kNeighbours; ++k) {
      const ScanProfile::Bin& next = profile.bins[wrapped(i + k)];
      if (!next.valid || std::abs(next.range_m - bin.range_m) > 0.1F + 0.3F * bin.range_m) continue;
      const Eigen::Vector2f d = next.p_m - bin.p_m;
      mean += d;
      moment += d * d.transpose();
      ++count;
    }
    if (count < kNeighbours) continue;
    mean /= static_cast<float>(count);
    const Eigen::Matrix2f spread = moment / static_cast<float>(count) - mean * mean.transpose();
    const float half = 0.5F * (spread(0, 0) + spread(1, 1));
    const float root = std::sqrt(std::max(0.0F, half * half - spread.determinant()));
    const float thickness_m = std::sqrt(std::max(0.0F, half - root));
    const float length_m = std::sqrt(half + root);
    if (thickness_m > 0.03F + 0.005F * bin.range_m || thickness_m > 0.4F * length_m) continue;
    // Normal: eigenvector of the smaller eigenvalue.
    const float along = 0.5F * std::atan2(2.0F * spread(0, 1), spread(0, 0) - spread(1, 1));
    bin.normal = {-std::sin(along), std::cos(along)};
    bin.centre_m = bin.p_m + mean;
    bin.has_line = true;
  }
}

ScanStep match_profiles(const ScanProfile& before, const ScanProfile& after) {
  ScanStep step;
  Eigen::Vector3d motion(static_cast<double>(kBinRad) * search_turn(before, after), 0.0, 0.0);
  double gate_m = 1.5;
  Normal last;
  for (int i = 0; i < kIterations; ++i) {
    last = normal_equations(before, after, motion, gate_m);
    if (last.pairs < kLeastMatches) return step;
    const Eigen::Matrix3d damped = last.H + 1e-3 * Eigen::Matrix3d::Identity() * last.pairs;
    const Eigen::Vector3d change = -damped.ldlt().solve(last.g);
    if (!change.allFinite()) return step;
    motion += change;
    gate_m = std::max(0.1, 0.7 * gate_m);
    if (change.norm() < 1e-5 && i > 8) break;
  }
  last = normal_equations(before, after, motion, gate_m);
  step.step = {motion[0], motion[1], motion[2]};
  judge(last, step);
  return step;
}

}  // namespace isobar

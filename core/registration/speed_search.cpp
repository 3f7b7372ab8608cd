// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/speed_search.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "core/squared.hpp"

namespace isobar {

namespace {

// Factor by which a velocity must fit better than to stand, and that at which one scan suffices: at 6 m/s in a street it is
// 3 to 6, of a robot that stands 1.
constexpr double kClearlyBetter = 1.3;
constexpr double kSure = 2.0;
// Residual of a right match: noise of ranges and of planes [m].
constexpr double kRightResidualM = 0.02;

// How firmly planes hold the direction that they hold least, less where the points lie beside them.
double fit_of(const MatchResult& match) {
  if (!match.solved) return 0.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(match.level_information,
                                                              Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] / squared(match.residual_rms_m + kRightResidualM);
}

}  // namespace

void SpeedSearch::restart() {
  scans_ = 0;
  done_ = false;
  hypotheses_[0] = {};
  std::size_t next = 1;
  for (const double speed_m_s : kSpeedsMS) {
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / kDirections;
      hypotheses_[next++] = {speed_m_s * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)), 0.0};
    }
  }
}

void SpeedSearch::add(std::size_t hypothesis, const MatchResult& match, const Eigen::Vector2d& moved_m,
                      double after_s) {
  Hypothesis& one = hypotheses_[hypothesis];
  one.fit += fit_of(match);
  if (match.solved && hypothesis != 0) one.v_map_m_s = moved_m / after_s;
}

void SpeedSearch::end_scan() {
  ++scans_;
  const std::size_t found = best();
  const bool sure = found == 0 || hypotheses_[found].fit > kSure * hypotheses_[0].fit;
  done_ = sure || scans_ >= kScans;
}

std::size_t SpeedSearch::best() const {
  std::size_t best = 0;
  double fit = kClearlyBetter * hypotheses_[0].fit;
  for (std::size_t i = 1; i < kHypotheses; ++i) {
    if (!(hypotheses_[i].fit > fit)) continue;
    best = i;
    fit = hypotheses_[i].fit;
  }
  return best;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/loop_selection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace isobar {

namespace {

// A loop that contradicts by this share of the worst one is dropped with it.
constexpr double kWorstShare = 0.5;
// Least eigenvalue of I - S. Of the only tie of a part of the graph nothing is left but rounding, and of its error the
// last step's 1e-6 m. A chain with a sigma of 100 m leaves (2 cm / 100 m)^2 = 4e-8 to a loop of 2 cm.
constexpr double kLeastRedundancy = 1e-8;

}  // namespace

double loop_distance(const WhitenedEdge& loop, bool taken, const GraphState& state, NormalSystem& system) {
  const RelativePoseError e = whitened_error(loop, state);
  const Matrix6d S = system.marginal({loop.edge.from, e.by_from}, {loop.edge.to, e.by_to});
  Matrix6d C = (1.0 + kLeastRedundancy) * Matrix6d::Identity();
  C += taken ? Matrix6d(-S) : S;
  return e.error.dot(C.ldlt().solve(e.error));
}

Relaxation LoopSelection::run(LoopWeights taken) {
  taken_ = std::move(taken);
  drops_.assign(taken_.size(), 0);
  result_ = {};
  relax_once();
  for (int round = 0;; ++round) {
    measure();
    if (!drop_worst() && (round >= gate_.rounds || !take_predicted())) return result_;
    relax_once();
  }
}

void LoopSelection::relax_once() {
  const int before = result_.iterations;
  result_ = relax(factors_, taken_, limits_, system_, state_);
  result_.iterations += before;
}

void LoopSelection::measure() {
  distance_.resize(taken_.size());
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    distance_[i] = loop_distance(factors_.loops[i], taken_[i] != 0, state_, system_);
  }
}

bool LoopSelection::drop_worst() {
  double worst = 1.0;
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    if (taken_[i] != 0) worst = std::max(worst, distance_[i] / gate_of(i));
  }
  bool any = false;
  const double limit = std::max(1.0, kWorstShare * worst);
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    if (taken_[i] == 0 || distance_[i] <= limit * gate_of(i)) continue;
    taken_[i] = 0;
    ++drops_[i];
    any = true;
  }
  return any;
}

bool LoopSelection::take_predicted() {
  bool any = false;
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    if (taken_[i] != 0 || distance_[i] > gate_of(i) || drops_[i] >= gate_.drops) continue;
    taken_[i] = 1;
    any = true;
  }
  return any;
}

}  // namespace isobar

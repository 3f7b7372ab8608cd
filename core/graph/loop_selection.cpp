// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/loop_selection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace isobar {

namespace {

// A loop that contradicts by this share of the worst one is dropped with it.
constexpr double kWorstShare = 0.5;
// Least eigenvalue of I - S: the only tie of a part of the graph has none left, and no error either. A chain of 1 km
// sigma leaves (1 cm / 1 km)^2 = 1e-10 to a loop of 1 cm.
constexpr double kLeastRedundancy = 1e-11;

}  // namespace

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
    const RelativePoseEdge& edge = factors_.loops[i].edge;
    const RelativePoseError e = whitened_error(factors_.loops[i], state_);
    const Matrix6d S = system_.marginal({edge.from, e.by_from}, {edge.to, e.by_to});
    Matrix6d C = (1.0 + kLeastRedundancy) * Matrix6d::Identity();
    C += taken_[i] != 0 ? Matrix6d(-S) : S;
    distance_[i] = e.error.dot(C.ldlt().solve(e.error));
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

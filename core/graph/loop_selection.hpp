// SPDX-License-Identifier: BSD-3-Clause
// Which loops of a pose graph are right: each must agree with all others that are taken, and with the chain.
//
// Truncated least squares over the loops (Yang, Antonante, Tzoumas, Carlone, "Graduated non-convexity for robust spatial
// perception", 2020, equation (14)): a loop costs its error, or `gate` and is left out. A loop is at its optimum, all others
// as they are, when it is taken exactly if the graph without it predicts it within the gate:
//
//     d^2 = e^T (I - S)^-1 e   of one that is taken (its deletion residual: Baarda, "A testing procedure for use in geodetic
//                              networks", 1968), d^2 = e^T (I + S)^-1 e of one that is left out,   S = J H^-1 J^T
//
// e, J: whitened error and Jacobian, H: normal equations. The error alone does not tell: a long chain bends so far that even
// a gross loop ends with a small one. For the same reason the search begins at the chain without loops, not with all of
// them as graduated non-convexity does: loops that are wrong together would hold each other.
// Each round takes all loops that the graph predicts; then it drops those that contradict most, half as much as the worst or
// more, and relaxes again, so that the right ones, which contradict because of a wrong one, stay.
#pragma once

#include <vector>

#include "core/graph/graph_factors.hpp"
#include "core/graph/relaxation.hpp"

namespace isobar {

/// When a loop is right.
struct LoopGate {
  /// Largest d^2 between nodes held by gravity (4 degrees of freedom): probability 1e-4 of losing a right loop.
  double chi_square_4 = 23.5;
  /// The same with 6 degrees of freedom.
  double chi_square_6 = 27.9;
  int rounds = 25;  ///< most rounds; then only drops
  int drops = 2;    ///< a loop that was dropped so often stays out

  [[nodiscard]] double of(const WhitenedEdge& loop) const { return loop.level ? chi_square_4 : chi_square_6; }
};

/// d^2 of a loop that is `taken` into account in `system`, which is factorised at `state`, or left out of it.
double loop_distance(const WhitenedEdge& loop, bool taken, const GraphState& state, NormalSystem& system);

/// Chooses loops and relaxes the graph with them.
class LoopSelection {
 public:
  LoopSelection(const GraphFactors& factors, const LoopGate& gate, const RelaxationLimits& limits,
                NormalSystem& system, GraphState& state)
      : factors_(factors), gate_(gate), limits_(limits), system_(system), state_(state) {}

  /// Begins with `taken`; leaves the graph at its minimum with the chosen loops.
  Relaxation run(LoopWeights taken);

  [[nodiscard]] const LoopWeights& taken() const { return taken_; }
  /// d^2 of each loop.
  [[nodiscard]] const std::vector<double>& distances() const { return distance_; }
  [[nodiscard]] double gate_of(std::size_t loop) const { return gate_.of(factors_.loops[loop]); }

 private:
  void relax_once();
  void measure();
  bool drop_worst();
  bool take_predicted();

  const GraphFactors& factors_;
  LoopGate gate_;
  RelaxationLimits limits_;
  NormalSystem& system_;
  GraphState& state_;
  LoopWeights taken_;
  std::vector<double> distance_;
  std::vector<int> drops_;
  Relaxation result_;
};

}  // namespace isobar

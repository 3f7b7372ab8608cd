// SPDX-License-Identifier: BSD-3-Clause
// Minimum of a pose graph's sum of squares for given loops: Gauss-Newton, damped where a step does not descend.
//
// Source of the damping: Marquardt, "An algorithm for least-squares estimation of nonlinear parameters", 1963.
#pragma once

#include "core/graph/graph_factors.hpp"

namespace isobar {

/// When a minimum is reached.
struct RelaxationLimits {
  int iterations = 30;     ///< most steps
  double step_m = 1e-6;    ///< the last step of every position and bias is shorter …
  double step_rad = 1e-8;  ///< … and that of every rotation: 1 mm at 100 km
};

/// How a minimum was reached.
struct Relaxation {
  int iterations = 0;
  double chi_square = 0.0;
  bool converged = false;
};

/// Moves `state` to the minimum and leaves `system` factorised there, but for the last step.
Relaxation relax(const GraphFactors& factors, const LoopWeights& loops, const RelaxationLimits& limits,
                 NormalSystem& system, GraphState& state);

}  // namespace isobar

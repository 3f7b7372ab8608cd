// SPDX-License-Identifier: BSD-3-Clause
#include "core/graph/relaxation.hpp"

#include <algorithm>

namespace isobar {

namespace {

constexpr double kFirstDamping = 1e-4;   // after a step that did not descend
constexpr double kDampingFactor = 10.0;  // from try to try
constexpr double kLargestDamping = 1e8;  // a step is then as good as none
constexpr double kRoundingShare = 1e-9;  // rise of the sum that is rounding of thousands of errors

GraphState moved_state(const GraphState& state, const std::vector<NodeStep>& steps) {
  GraphState out = state;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    if (steps[n].isZero(0.0)) continue;
    out.nodes[n].T_map_submap = moved(state.nodes[n].T_map_submap, steps[n]);
    out.bias_m[n] += steps[n](kBiasColumn);
  }
  return out;
}

bool is_short(const std::vector<NodeStep>& steps, const RelaxationLimits& limits) {
  return std::all_of(steps.begin(), steps.end(), [&](const NodeStep& step) {
    return step.head<3>().cwiseAbs().maxCoeff() < limits.step_m &&
           std::abs(step(kBiasColumn)) < limits.step_m &&
           step.segment<3>(3).cwiseAbs().maxCoeff() < limits.step_rad;
  });
}

}  // namespace

Relaxation relax(const GraphFactors& factors, const LoopWeights& loops, const RelaxationLimits& limits,
                 NormalSystem& system, GraphState& state) {
  Relaxation result{0, chi_square(factors, loops, state), false};
  std::vector<NodeStep> steps;
  double damping = 0.0;
  while (result.iterations < limits.iterations && damping < kLargestDamping && !result.converged) {
    ++result.iterations;
    linearise(factors, loops, state, system);
    if (!system.factorise(damping)) {
      damping = std::max(kFirstDamping, kDampingFactor * damping);
      continue;
    }
    system.solve(steps);
    GraphState next = moved_state(state, steps);
    const double next_chi_square = chi_square(factors, loops, next);
    const bool is_last = damping == 0.0 && is_short(steps, limits);
    if (next_chi_square <= (1.0 + kRoundingShare) * result.chi_square || is_last) {
      state = std::move(next);
      result.chi_square = next_chi_square;
      result.converged = is_last;
      damping = damping > kFirstDamping ? damping / kDampingFactor : 0.0;
    } else {
      damping = std::max(kFirstDamping, kDampingFactor * damping);
    }
  }
  if (!result.converged) {
    linearise(factors, loops, state, system);
    system.factorise(0.0);
  }
  return result;
}

}  // namespace isobar

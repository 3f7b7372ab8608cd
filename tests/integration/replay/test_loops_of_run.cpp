// SPDX-License-Identifier: BSD-3-Clause
// A run that comes back the way it went: the trajectory that its loops correct.
#include <doctest/doctest.h>

#include <filesystem>

#include "run/evaluation/evaluated_run.hpp"
#include "run/files/run_layout.hpp"
#include "simulation/simulate.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_loops_of_run {
namespace {

TEST_CASE("a robot that returns over two floors has a corrected trajectory, not worse than the live one") {
  simulation::ScenarioRequest request;
  request.name = "round-trip";
  request.seed = 1;
  request.short_form = true;
  const auto recording = fresh_folder("round-trip");
  simulation::simulate(request, recording, {});
  std::filesystem::path out;
  const ReplaySummary summary = run(recording, out, Method::kAdaptive);
  CHECK(summary.loops >= 10);  // 60 m of the way back, a pair of loops every few metres
  const auto corrected = out / files::kCorrectedTrajectoryFile;
  REQUIRE(std::filesystem::exists(corrected));
  const auto evaluated = evaluation::evaluate_methods(evaluation::load_reference(recording),
                                                      {{"live", out}, {"corrected", corrected}});
  const double live_m = evaluated.methods.at(0).evaluation.figures.ate_rms_m;
  const double corrected_m = evaluated.methods.at(1).evaluation.figures.ate_rms_m;
  MESSAGE("ATE rms live " << live_m << " m, corrected " << corrected_m << " m");
  // 0.033 and 0.025 m; a live run drifts too little here for more. A wrong loop between the floors would cost metres.
  CHECK(corrected_m < live_m);
  CHECK(corrected_m < 0.04);
}

}  // namespace
}  // namespace isobar::test::test_loops_of_run

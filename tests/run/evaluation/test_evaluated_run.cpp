// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/files/text_file.hpp"
#include "tests/run/evaluation/runs.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_evaluated_run {

using namespace isobar::evaluation;
using isobar::test::TemporaryFolder;

TEST_CASE("two runs over a recording are evaluated with its segments and their sigma, map and status") {
  const TemporaryFolder folder;
  const EvaluatedRun run = two_methods(folder.path());
  REQUIRE(run.methods.size() == 2);
  CHECK(run.methods[0].name == "3dof");
  CHECK(run.methods[1].evaluation.figures.z_rpe.median == doctest::Approx(0.05).epsilon(1e-3));
  CHECK(run.methods[0].evaluation.figures.sigma_share == doctest::Approx(1.0));  // 6 cm against 2 * 10 cm
  CHECK(run.methods[1].evaluation.figures.sigma_share < 0.1);
  CHECK_FALSE(run.methods[0].evaluation.figures.whole_run_as_flat);
  REQUIRE(run.methods[0].map_points.size() == 2000);
  // Moved into the reference's frame.
  CHECK(run.methods[0].map_points[0][0] == doctest::Approx(0.0).epsilon(1e-4));
  CHECK(run.methods[0].map_points[0][2] == doctest::Approx(0.0).epsilon(1e-4));
  CHECK(run.notes.empty());
}

TEST_CASE("an estimate is named after its folder or file, or its whole path where two names are equal") {
  std::vector<EstimateSource> sources{{"", "runs/3dof"}, {"", "runs/4dof/"}, {"", "x/trajectory.tum"},
                                      {"", "a/run.tum"}, {"", "b/run.tum"},  {"mine", "c"}};
  default_names(sources);
  CHECK(sources[0].name == "3dof");
  CHECK(sources[1].name == "4dof");
  CHECK(sources[2].name == "x");
  CHECK(sources[3].name == "a/run.tum");
  CHECK(sources[4].name == "b/run.tum");
  CHECK(sources[5].name == "mine");
}

TEST_CASE("the corrected trajectories of runs that have one follow the runs") {
  const TemporaryFolder folder;
  for (const char* run : {"a", "b"}) std::filesystem::create_directories(folder.path() / run);
  files::write_text_file(folder.path() / "b" / files::kCorrectedTrajectoryFile, "1 0 0 0 0 0 0 1\n");
  std::vector<EstimateSource> sources{{"", folder.path() / "a"}, {"", folder.path() / "b"}};
  add_corrected(sources);
  REQUIRE(sources.size() == 3);
  CHECK(sources[1].name == "b");
  CHECK(sources[2].name == "b corrected");
  CHECK(sources[2].path == folder.path() / "b" / files::kCorrectedTrajectoryFile);
}

TEST_CASE("an estimate that shares no time with the reference is refused with its file name") {
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / "r.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  files::write_text_file(folder.path() / "e.tum", "91 0 0 0 0 0 0 1\n");
  const std::string message = message_of([&] {
    evaluate_methods(load_reference(folder.path() / "r.tum"), {{"", folder.path() / "e.tum"}});
  });
  CHECK(message.find("e.tum: begins 89 s after the end of the reference") != std::string::npos);
}

TEST_CASE("a run that drifts off is silently wrong as long as its status calls the poses registered") {
  const TemporaryFolder folder;
  const std::filesystem::path recording = write_recording(folder.path() / "recording");
  for (const bool says_so : {false, true}) {
    files::PoseWriter writer(folder.path() / (says_so ? "said" : "silent"));
    for (const StampedPose& p : straight(60.0, 0.1, 0.02).poses) {  // 2 cm of height a metre and second
      PoseEstimate pose;
      pose.stamp_ns = p.stamp_ns;
      pose.T_map_base.translation() = p.position_m;
      pose.covariance = 1e-4 * Matrix6d::Identity();
      const bool off = p.position_m.z() > 0.8;
      pose.mode = says_so && off ? PoseMode::kPriorOnly : PoseMode::kRegistered;
      writer.add(pose, 0.0, 0.05);
    }
    writer.flush();
  }
  const EvaluatedRun run = evaluate_methods(
      load_reference(recording), {{"silent", folder.path() / "silent"}, {"said", folder.path() / "said"}});
  // Wrong from 0.3 m on, at 15 s; the other run says so from 0.8 m on, at 40 s.
  CHECK(run.methods[0].evaluation.figures.consistency.longest_silent_s ==
        doctest::Approx(45.0).epsilon(0.01));
  CHECK(run.methods[1].evaluation.figures.consistency.longest_silent_s ==
        doctest::Approx(25.0).epsilon(0.01));
}

}  // namespace isobar::test::test_evaluated_run

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/errors.hpp"
#include "run/evaluation/figures.hpp"
#include "tests/run/evaluation/paths.hpp"

namespace isobar::test::test_figures {

using namespace isobar::evaluation;
using namespace isobar::test;
using doctest::Approx;

namespace {

/// Estimate with a step of the height by `step_m` at `at_s`.
Trajectory stepped(Trajectory t, double at_s, double step_m) {
  for (StampedPose& p : t.poses) {
    if (p.stamp_ns >= at_ns(at_s)) p.position_m.z() += step_m;
  }
  return t;
}

}  // namespace

TEST_CASE("a perfect estimate in another frame has no error and full coverage, and is not lost") {
  const Trajectory reference = winding(100.0, 0.05);
  const Evaluation e = evaluate(reference, {}, transformed(yaw_and_shift(1.5, {1, 2, 3}), reference), {});
  CHECK(e.figures.ate_max_m < 1e-9);
  CHECK(e.figures.z_rpe.max < 1e-9);
  CHECK(std::abs(e.figures.yaw_drift_rad) < 1e-9);
  CHECK(e.figures.coverage == Approx(1.0));
  CHECK(e.figures.whole_run_as_flat);
  CHECK(e.figures.verdict.ok());
  CHECK(std::isnan(e.figures.sigma_share));
}

TEST_CASE("a height that drifts by 2 % over 100 m: z-RPE 2 %, final height error 2 m, ATE 2/sqrt(3) m") {
  const Evaluation e = evaluate(straight(100.0, 0.01), {}, straight(100.0, 0.1, 0.02), {});
  CHECK(e.figures.z_rpe.median == Approx(0.02).epsilon(1e-6));
  CHECK(e.figures.z_rpe.p95 == Approx(0.02).epsilon(1e-6));
  CHECK(e.figures.final_height_error_m == Approx(2.0).epsilon(1e-6));
  CHECK(e.figures.largest_height_error_m == Approx(2.0).epsilon(1e-6));
  CHECK(e.figures.ate_rms_m ==
        Approx(2.0 / std::sqrt(3.0)).epsilon(2e-3));  // of a ramp; 1001 samples of the integral
  CHECK(e.figures.travelled_m == Approx(100.0).epsilon(1e-9));
  CHECK(e.figures.ate_share == Approx(0.02 / std::sqrt(3.0)).epsilon(2e-3));
}

TEST_CASE("a heading that drifts by 0.1 degree per metre has a signed yaw drift of 10 degrees after 100 m") {
  const Evaluation left = evaluate(straight(100.0, 0.01), {}, straight(100.0, 0.1, 0.0, 0.1 * kDegree), {});
  CHECK(left.figures.yaw_drift_rad / kDegree == Approx(10.0).epsilon(1e-6));
  CHECK(left.figures.yaw_drift_rad_m * 100.0 / kDegree == Approx(10.0).epsilon(1e-6));
  const Evaluation right = evaluate(straight(100.0, 0.01), {}, straight(100.0, 0.1, 0.0, -0.1 * kDegree), {});
  CHECK(right.figures.yaw_drift_rad / kDegree == Approx(-10.0).epsilon(1e-6));
}

TEST_CASE("the alignment at the start removes a wrong initial heading and the displacement it causes") {
  const Trajectory reference = winding(60.0, 0.05);
  const Evaluation e =
      evaluate(reference, {}, transformed(yaw_and_shift(30 * kDegree, {0, 0, 0}), reference), {});
  CHECK(e.figures.ate_max_m < 1e-9);
}

TEST_CASE("figures are invariant when reference and estimate move together by yaw and translation") {
  const Trajectory reference = winding(100.0, 0.05);
  Trajectory estimate = transformed(yaw_and_shift(0.3, {0, 1, 0}), winding(100.0, 0.1));
  for (std::size_t i = 0; i < estimate.poses.size(); ++i)
    estimate.poses[i].position_m.z() += 1e-4 * static_cast<double>(i);
  const Eigen::Isometry3d move = yaw_and_shift(-2.0, {40, -30, 20});
  const MethodFigures a = evaluate(reference, {}, estimate, {}).figures;
  const MethodFigures b = evaluate(transformed(move, reference), {}, transformed(move, estimate), {}).figures;
  CHECK(a.z_rpe.median > 1e-5);
  CHECK(b.z_rpe.median == Approx(a.z_rpe.median).epsilon(1e-6));
  CHECK(b.z_rpe.p95 == Approx(a.z_rpe.p95).epsilon(1e-6));
  CHECK(b.ate_rms_m == Approx(a.ate_rms_m).epsilon(1e-9));
  CHECK(b.rpe_translation.median == Approx(a.rpe_translation.median).epsilon(1e-6));
  CHECK(b.final_height_error_m == Approx(a.final_height_error_m).epsilon(1e-9));
}

TEST_CASE("z-RPE covers flat segments only: an error made on stairs appears in the floor heights instead") {
  const std::vector<Segment> segments{
      {at_ns(0), at_ns(40), "flat"}, {at_ns(40), at_ns(60), "stairs"}, {at_ns(60), at_ns(100), "flat"}};
  const auto climb = [](double t) { return t < 40 ? 0.0 : (t < 60 ? 0.2 * (t - 40) : 4.0); };
  const Trajectory reference = sampled(100.0, 0.01, [&](double t) {
    return StampedPose{0, {t, 0, climb(t)}, Eigen::Quaterniond::Identity()};
  });
  const MethodFigures f = evaluate(reference, segments, stepped(reference, 50.0, 0.3), {}).figures;
  CHECK_FALSE(f.whole_run_as_flat);
  CHECK(f.z_rpe.max < 1e-9);
  REQUIRE(f.floors.size() == 2);
  CHECK(f.floors[0].reference_m == Approx(0.0));
  CHECK(f.floors[0].mean_error_m == Approx(0.0));
  CHECK(f.floors[1].reference_m == Approx(4.0).epsilon(1e-3));
  CHECK(f.floors[1].mean_error_m == Approx(0.3));
}

TEST_CASE("a floor visited twice is one floor, with the error of its worst visit") {
  const std::vector<Segment> segments{
      {at_ns(0), at_ns(20), "flat"}, {at_ns(40), at_ns(60), "flat"}, {at_ns(80), at_ns(100), "flat"}};
  const Trajectory reference = sampled(100.0, 0.05, [](double t) {
    return StampedPose{0, {t, 0, t < 30 || t > 70 ? 8.0 : 0.0}, Eigen::Quaterniond::Identity()};
  });
  const MethodFigures f = evaluate(reference, segments, stepped(reference, 70.0, -0.2), {}).figures;
  REQUIRE(f.floors.size() == 2);
  CHECK(f.floors[0].visits == 1);
  CHECK(f.floors[1].visits == 2);
  CHECK(f.floors[1].worst_error_m == Approx(-0.2));
  CHECK(f.floors[1].mean_error_m == Approx(-0.1).epsilon(1e-6));
}

TEST_CASE("a run is lost when it leaves the reference far behind, incomplete when it stops early, else ok") {
  const Trajectory reference = straight(200.0, 0.01);
  const auto verdict_on_run = [&](const Trajectory& estimate) {
    return evaluate(reference, {}, estimate, {}).figures.verdict;
  };
  CHECK(verdict_on_run(straight(200.0, 0.1, 0.02)).kind == VerdictKind::kOk);  // 4 m in 200 m
  const Verdict early = verdict_on_run(straight(180.0, 0.1));
  CHECK(early.kind == VerdictKind::kIncomplete);
  CHECK(early.reason == "covers 90 % of 200.0 s: ends 20.0 s early");
  const Verdict lost = verdict_on_run(stepped(straight(200.0, 0.1), 100.0, 20.0));
  CHECK(lost.kind == VerdictKind::kLost);
  CHECK(lost.reason.starts_with("off by 20.0 m at 100."));
  CHECK(lost.reason.ends_with("beyond 10.0 m"));
}

TEST_CASE("an incomplete run says what is missing: late begin and gaps") {
  Trajectory estimate = straight(100.0, 0.1);
  std::erase_if(estimate.poses, [](const StampedPose& p) {
    return p.stamp_ns < at_ns(10.0) || (p.stamp_ns > at_ns(50.0) && p.stamp_ns < at_ns(58.0));
  });
  const Verdict verdict = evaluate(straight(100.0, 0.01), {}, estimate, {}).figures.verdict;
  CHECK(verdict.reason == "covers 82 % of 100.0 s: begins 10.0 s late, gaps of 8.0 s");
}

TEST_CASE(
    "a reference of one pose a second gives the figures of a dense one, whichever of the two is sparse") {
  const Trajectory dense = straight(60.0, 0.1, 0.02);
  const Trajectory sparse = straight(60.0, 1.0);
  const MethodFigures of_dense = evaluate(straight(60.0, 0.01), {}, dense, {}).figures;
  for (const MethodFigures& f : {evaluate(sparse, {}, dense, {}).figures,
                                 evaluate(straight(60.0, 0.1), {}, straight(60.0, 1.0, 0.02), {}).figures}) {
    CHECK(f.verdict.ok());
    CHECK(f.coverage == Approx(1.0));
    CHECK(f.paired == 61);
    CHECK(f.outside == 0);
    // A straight path at one speed: interpolation is exact; the root mean square is over other times.
    CHECK(f.final_height_error_m == Approx(of_dense.final_height_error_m).epsilon(1e-6));
    CHECK(f.ate_rms_m == Approx(of_dense.ate_rms_m).epsilon(0.02));
    CHECK(f.z_rpe.count > 0);
    CHECK(f.z_rpe.median == Approx(of_dense.z_rpe.median).epsilon(1e-6));
  }
}

TEST_CASE("a reference without attitude is aligned by its path, and angles are not compared") {
  Trajectory positions = winding(60.0, 1.0);
  for (StampedPose& pose : positions.poses) pose.attitude = Eigen::Quaterniond::Identity();
  const Trajectory estimate = transformed(yaw_and_shift(1.3, {3, -4, 5}), winding(60.0, 0.1));
  const MethodFigures f = evaluate(positions, {}, estimate, {}).figures;
  CHECK_FALSE(f.reference_attitude);
  CHECK(f.ate_max_m < 1e-6);  // rounding only: the stamps of the reference are among the estimate's
  CHECK(std::isnan(f.yaw_drift_rad));
  CHECK(f.verdict.ok());
}

TEST_CASE("two trajectories without a common time are told apart from one with gaps") {
  const auto message = [](const Trajectory& reference, const Trajectory& estimate,
                          std::optional<double> gap_s) {
    EvaluationOptions options;
    options.max_gap_s = gap_s;
    try {
      (void)evaluate(reference, {}, estimate, {}, options);
    } catch (const DataError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Trajectory later = straight(10.0, 0.1);
  for (StampedPose& pose : later.poses) pose.stamp_ns += at_ns(20.0) - at_ns(0.0);
  CHECK(message(straight(10.0, 0.1), later, std::nullopt) == "begins 10 s after the end of the reference");
  CHECK(message(later, straight(10.0, 0.1), std::nullopt) == "ends 10 s before the start of the reference");
  Trajectory between = straight(9.0, 1.0);
  for (StampedPose& pose : between.poses) pose.stamp_ns += 500'000'000;
  CHECK(message(straight(10.0, 1.0), between, 0.5) ==
        "the reference has one pose in 1 s, further apart than the longest gap of 0.5 s");
}

TEST_CASE("a height error that grows evenly to 2 m is within two sigma of 0.5 m for half of the time") {
  const Trajectory estimate = straight(100.0, 0.1, 0.02);
  std::vector<HeightSigma> sigmas;
  for (const StampedPose& p : estimate.poses) sigmas.push_back({p.stamp_ns, 0.5});
  CHECK(evaluate(straight(100.0, 0.01), {}, estimate, sigmas).figures.sigma_share ==
        Approx(0.5).epsilon(0.01));
}

TEST_CASE("trajectories without a common time are refused") {
  Trajectory late = straight(10.0, 0.1);
  for (StampedPose& p : late.poses) p.stamp_ns += 1'000'000'000'000;
  CHECK_THROWS_AS(evaluate(straight(10.0, 0.1), {}, late, {}), isobar::DataError);
}

TEST_CASE("floors after the first minute: errors of the first 60 s do not count") {
  // 1 m/s: a floor of 100 s, of which the estimate is 0.5 m too high from 10 to 40 s and 3 cm from 70 s on.
  Trajectory estimate = stepped(straight(100.0, 0.1), 10.0, 0.5);
  estimate = stepped(stepped(estimate, 40.0, -0.5), 70.0, 0.03);
  const std::vector<Segment> flat{{at_ns(0.0), at_ns(100.0), "flat"}};
  const MethodFigures figures = evaluate(straight(100.0, 0.01), flat, estimate, {}).figures;
  // 31 of the 41 s after the first minute, at 10 Hz and with both ends.
  CHECK(figures.settled_floors_mean_m == Approx(0.03 * 301.0 / 401.0).epsilon(1e-6));
  CHECK(figures.settled_floors_worst_m == Approx(figures.settled_floors_mean_m));
  CHECK(figures.floors.front().mean_error_m > 0.1);
  // A run of less than a minute, and one without floors.
  const std::vector<Segment> brief{{at_ns(0.0), at_ns(50.0), "flat"}};
  CHECK(std::isnan(
      evaluate(straight(50.0, 0.01), brief, straight(50.0, 0.1), {}).figures.settled_floors_mean_m));
  CHECK(std::isnan(evaluate(straight(100.0, 0.01), {}, estimate, {}).figures.settled_floors_worst_m));
}

}  // namespace isobar::test::test_figures

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "run/evaluation/relative_error.hpp"
#include "tests/run/evaluation/paths.hpp"

namespace isobar::test::test_relative_error {

using namespace isobar::evaluation;
using namespace isobar::test;

namespace {

std::vector<PosePair> pairs_of(const Trajectory& reference, const Trajectory& estimate) {
  return associate(reference, estimate, 0.5);
}

}  // namespace

TEST_CASE("a height that drifts by 2 % of the way has a relative error on z of 2 % in every window") {
  const std::vector<PosePair> pairs = pairs_of(straight(40.0, 0.01), straight(40.0, 0.1, 0.02));
  const std::vector<Window> windows = make_windows(pairs, nullptr, {5.0, 0.1});
  CHECK(windows.size() == 351);  // starts 0.0, 0.1 … 35.0 m
  for (const double error : relative_z_error(pairs, windows))
    CHECK(error == doctest::Approx(0.02).epsilon(1e-6));
}

TEST_CASE("both ends of a window lie in the same segment") {
  const std::vector<PosePair> pairs = pairs_of(straight(40.0, 0.01), straight(40.0, 0.1));
  const std::vector<Segment> segments{
      {at_ns(0), at_ns(12), "flat"}, {at_ns(20), at_ns(24.5), "flat"}, {at_ns(30), at_ns(36), "flat"}};
  const std::vector<Window> windows = make_windows(pairs, &segments, {5.0, 0.1});
  REQUIRE_FALSE(windows.empty());
  bool in_third = false;
  for (const Window& window : windows) {
    const bool first = segments[0].contains(pairs[window.first].stamp_ns) &&
                       segments[0].contains(pairs[window.last].stamp_ns);
    const bool third = segments[2].contains(pairs[window.first].stamp_ns) &&
                       segments[2].contains(pairs[window.last].stamp_ns);
    CHECK((first || third));  // the second is shorter than a window
    in_third = in_third || third;
    CHECK(window.travelled_m >= 5.0 - 1e-5);
    CHECK(window.travelled_m <= 5.2);
  }
  CHECK(in_third);
}

TEST_CASE("neither a rest nor a higher pose rate adds windows") {
  const auto pausing = [](double step_s) {
    return sampled(60.0, step_s, [](double t) {  // 20 m, 20 s of rest, 20 m
      const double x = t < 20 ? t : (t < 40 ? 20.0 : t - 20.0);
      return StampedPose{0, {x, 0, 0}, Eigen::Quaterniond::Identity()};
    });
  };
  const auto count = [&](double step_s) {
    const Trajectory reference = pausing(0.01);
    return static_cast<double>(
        make_windows(pairs_of(reference, pausing(step_s)), nullptr, {5.0, 0.1}).size());
  };
  CHECK(count(0.1) == doctest::Approx(351).epsilon(0.01));
  CHECK(count(0.01) == doctest::Approx(351).epsilon(0.01));
}

TEST_CASE("a window that a gap of the estimate makes too long is left out") {
  Trajectory estimate = straight(40.0, 0.1);
  std::erase_if(estimate.poses,
                [](const StampedPose& p) { return p.stamp_ns > at_ns(10) && p.stamp_ns < at_ns(20); });
  const std::vector<PosePair> pairs = pairs_of(straight(40.0, 0.01), estimate);
  for (const Window& window : make_windows(pairs, nullptr, {5.0, 0.1})) CHECK(window.travelled_m < 5.6);
}

TEST_CASE("a scale error of 3 % is a relative translation error of 3 % without a rotation error") {
  Trajectory estimate = straight(40.0, 0.1);
  for (StampedPose& p : estimate.poses) p.position_m *= 1.03;
  const std::vector<PosePair> pairs = pairs_of(straight(40.0, 0.01), estimate);
  for (const RelativePoseError& e : relative_pose_error(pairs, make_windows(pairs, nullptr, {10.0, 0.1}))) {
    CHECK(e.translation == doctest::Approx(0.03).epsilon(1e-6));
    CHECK(e.rotation_rad_m == doctest::Approx(0.0).epsilon(1e-7));
  }
}

TEST_CASE("a heading drift of half a degree per metre is that relative rotation error") {
  const std::vector<PosePair> pairs = pairs_of(straight(40.0, 0.01), straight(40.0, 0.1, 0.0, 0.5 * kDegree));
  const std::vector<Window> windows = make_windows(pairs, nullptr, {10.0, 0.1});
  REQUIRE_FALSE(windows.empty());
  for (const RelativePoseError& e : relative_pose_error(pairs, windows)) {
    CHECK(e.rotation_rad_m / kDegree == doctest::Approx(0.5).epsilon(1e-6));
  }
}

TEST_CASE("relative errors are invariant when the estimate is moved by yaw and translation") {
  const Trajectory reference = winding(60.0, 0.05);
  Trajectory estimate = reference;
  for (StampedPose& p : estimate.poses)
    p.position_m.z() += 0.1 * std::sin(static_cast<double>(p.stamp_ns - kStartNs) * 1e-9);
  const std::vector<PosePair> here = pairs_of(reference, estimate);
  const std::vector<PosePair> there =
      pairs_of(reference, transformed(yaw_and_shift(1.0, {9, 8, 7}), estimate));
  const std::vector<Window> windows = make_windows(here, nullptr, {5.0, 0.1});
  const std::vector<double> z_here = relative_z_error(here, windows);
  const std::vector<double> z_there = relative_z_error(there, windows);
  const std::vector<RelativePoseError> p_here = relative_pose_error(here, windows);
  const std::vector<RelativePoseError> p_there = relative_pose_error(there, windows);
  REQUIRE(windows.size() > 100);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    CHECK(z_there[i] == doctest::Approx(z_here[i]).epsilon(1e-9));
    CHECK(p_there[i].translation == doctest::Approx(p_here[i].translation).epsilon(1e-9));
  }
}

}  // namespace isobar::test::test_relative_error

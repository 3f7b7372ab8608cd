// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <random>

#include "run/evaluation/association.hpp"
#include "tests/run/evaluation/paths.hpp"

namespace isobar::test::test_association {

using namespace isobar::evaluation;
using namespace isobar::test;

namespace {

/// Trajectory without the poses in (from_s, to_s).
Trajectory with_hole(Trajectory t, double from_s, double to_s) {
  std::erase_if(t.poses,
                [&](const StampedPose& p) { return p.stamp_ns > at_ns(from_s) && p.stamp_ns < at_ns(to_s); });
  return t;
}

/// Largest distance between estimate and reference.
double largest_distance_m(const std::vector<PosePair>& pairs) {
  double largest = 0.0;
  for (const PosePair& p : pairs)
    largest = std::max(largest, (p.estimate.position_m - p.reference.position_m).norm());
  return largest;
}

}  // namespace

TEST_CASE(
    "the reference is interpolated at the estimate's stamps, exactly on a straight path at a constant turn "
    "rate") {
  const Trajectory reference = straight(10.0, 0.125, 0.1, 0.2);
  const Trajectory estimate = straight(10.0, 0.1, 0.1, 0.2);
  const std::vector<PosePair> pairs = associate(reference, estimate, 0.5);
  REQUIRE(pairs.size() == estimate.poses.size());
  for (const PosePair& pair : pairs) {
    CHECK((pair.reference.position_m - pair.estimate.position_m).norm() < 1e-9);
    CHECK(pair.reference.attitude.angularDistance(pair.estimate.attitude) <
          1e-7);  // slerp of a rotation about one axis
    CHECK(pair.distance_m == doctest::Approx(pair.estimate.position_m.norm()).epsilon(1e-9));
  }
}

TEST_CASE("poses before, after and in a long gap of the reference have no pair") {
  const Trajectory estimate = straight(10.0, 0.1);
  Trajectory reference = with_hole(straight(10.0, 0.01), 4.0, 6.0);
  std::erase_if(reference.poses,
                [](const StampedPose& p) { return p.stamp_ns < at_ns(1.0) || p.stamp_ns > at_ns(9.0); });
  const std::vector<PosePair> pairs = associate(reference, estimate, 0.5);
  CHECK(pairs.size() == 31 + 31);  // 1.0 … 4.0 and 6.0 … 9.0
  CHECK(associate(reference, straight(10.0, 0.1), 2.5).size() == 81);
}

TEST_CASE("coverage is the share of time outside gaps") {
  const Trajectory reference = straight(10.0, 0.01);
  CHECK(coverage(reference, straight(10.0, 0.1), 0.5) == doctest::Approx(1.0));
  CHECK(coverage(reference, with_hole(straight(10.0, 0.1), 3.0, 5.0), 0.5) == doctest::Approx(0.8));
  CHECK(coverage(reference, with_hole(straight(10.0, 0.1), 3.0, 3.4), 0.5) == doctest::Approx(1.0));
  CHECK(coverage(reference, straight(7.5, 0.1), 0.5) == doctest::Approx(0.75));  // stops early
  CHECK(coverage(reference, with_hole(straight(10.0, 0.1), -1.0, 2.0), 0.5) ==
        doctest::Approx(0.8));  // starts late
  CHECK(coverage(reference, Trajectory{}, 0.5) == 0.0);
}

TEST_CASE("every alignment recovers a reference that was moved by yaw and translation") {
  const Trajectory reference = winding(60.0, 0.05);
  const Trajectory estimate = transformed(yaw_and_shift(2.2, {5, -7, 3}), reference);
  for (const Alignment alignment : {Alignment::kStart, Alignment::kYawTranslation, Alignment::kRigid}) {
    std::vector<PosePair> pairs = associate(reference, estimate, 0.5);
    apply_transform(pairs, alignment_transform(pairs, alignment));
    CHECK(largest_distance_m(pairs) < 1e-9);
    for (const PosePair& p : pairs) REQUIRE(p.estimate.attitude.angularDistance(p.reference.attitude) < 1e-7);
  }
}

TEST_CASE("only the rigid alignment removes tilt, which is an error of a gravity-aligned estimate") {
  const Trajectory reference = winding(60.0, 0.05);
  Eigen::Isometry3d tilt = yaw_and_shift(0.4, {1, 2, 3});
  tilt.rotate(Eigen::AngleAxisd(5 * kDegree, Eigen::Vector3d::UnitX()));
  const std::vector<PosePair> pairs = associate(reference, transformed(tilt, reference), 0.5);
  const auto left_m = [&](Alignment alignment) {
    std::vector<PosePair> moved = pairs;
    apply_transform(moved, alignment_transform(moved, alignment));
    return largest_distance_m(moved);
  };
  CHECK(left_m(Alignment::kRigid) < 1e-9);
  CHECK(left_m(Alignment::kStart) > 1.0);  // 60 m along y, tilted by 5 degrees: 5 m
  CHECK(left_m(Alignment::kYawTranslation) > 1.0);
}

TEST_CASE("the yaw alignment is a minimum of the sum of squared distances") {
  std::mt19937 random(5);
  std::normal_distribution<double> noise_m(0.0, 0.3);
  const Trajectory reference = winding(60.0, 0.1);
  Trajectory estimate = transformed(yaw_and_shift(-1.1, {3, 1, -2}), reference);
  for (StampedPose& p : estimate.poses)
    p.position_m += Eigen::Vector3d(noise_m(random), noise_m(random), noise_m(random));
  std::vector<PosePair> pairs = associate(reference, estimate, 0.5);
  apply_transform(pairs, alignment_transform(pairs, Alignment::kYawTranslation));
  const auto cost = [](const std::vector<PosePair>& moved) {
    double sum = 0.0;
    for (const PosePair& p : moved) sum += (p.estimate.position_m - p.reference.position_m).squaredNorm();
    return sum;
  };
  const double best = cost(pairs);
  for (const double sign : {-1.0, 1.0}) {
    for (int axis = 0; axis < 4; ++axis) {
      std::vector<PosePair> moved = pairs;
      apply_transform(moved, axis == 3 ? yaw_and_shift(sign * 1e-3, {0, 0, 0})
                                       : yaw_and_shift(0.0, sign * 1e-3 * Eigen::Vector3d::Unit(axis)));
      CHECK(cost(moved) > best);
    }
  }
}

}  // namespace isobar::test::test_association

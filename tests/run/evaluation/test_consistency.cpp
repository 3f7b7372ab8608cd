// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/consistency.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <vector>

#include "core/so3.hpp"
#include "run/evaluation/figures.hpp"
#include "tests/run/evaluation/paths.hpp"

namespace isobar::test::test_consistency {

using namespace isobar::evaluation;
using namespace isobar::test;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr std::size_t kPoses = 4000;

/// A covariance with correlations between all components: centimetres and tenths of a degree.
Matrix6 some_covariance() {
  Matrix6 root;
  root.setIdentity();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) root(i, j) = 0.3 * std::sin(1.0 + 2.0 * i + 3.0 * j);
  }
  const Vector6 sizes{{0.05, 0.03, 0.02, 0.002, 0.003, 0.010}};
  root = sizes.asDiagonal() * root;
  return root * root.transpose();
}

struct Run {
  std::vector<PosePair> pairs;
  std::vector<PoseCovariance> covariances;
};

/// Independent errors of `truth`, claimed to be of `claim`.
Run draw(const Matrix6& truth, const Matrix6& claim) {
  const Matrix6 root = truth.llt().matrixL();
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  Run run;
  for (std::size_t i = 0; i < kPoses; ++i) {
    Vector6 error;
    for (int k = 0; k < 6; ++k) error[k] = normal(engine);
    error = root * error;
    PosePair pair;
    pair.stamp_ns = 1000 + static_cast<std::int64_t>(i);
    pair.estimate.stamp_ns = pair.stamp_ns;
    pair.reference.attitude = rotation_from_rpy({0.1, -0.2, 0.01 * static_cast<double>(i)});
    pair.reference.position_m = Vector3d(static_cast<double>(i), 2.0, 3.0);
    pair.estimate.position_m = pair.reference.position_m + error.head<3>();
    pair.estimate.attitude = exp_so3(error.tail<3>()) * pair.reference.attitude;
    run.pairs.push_back(pair);
    run.covariances.push_back({pair.stamp_ns, claim});
  }
  return run;
}

ConsistencyFigures figures_of(const Run& run) {
  return consistency_of(run.pairs, run.covariances, Eigen::Isometry3d::Identity());
}

/// Four standard deviations of a share among kPoses independent poses: one false alarm in 16 000.
double tolerance(double share) { return 4.0 * std::sqrt(share * (1.0 - share) / kPoses); }

}  // namespace

TEST_CASE("errors that are as large as claimed: 95 % within every ellipsoid, mean NEES of 6") {
  const ConsistencyFigures figures = figures_of(draw(some_covariance(), some_covariance()));
  CHECK(figures.poses == kPoses);
  CHECK(std::abs(figures.within_95 - 0.95) < tolerance(0.95));
  CHECK(std::abs(figures.within_95_position - 0.95) < tolerance(0.95));
  CHECK(std::abs(figures.within_95_orientation - 0.95) < tolerance(0.95));
  for (const double share : figures.within_95_component) CHECK(std::abs(share - 0.95) < tolerance(0.95));
  // Chi-squared with 6 degrees of freedom has a variance of 12.
  CHECK(std::abs(figures.nees - 1.0) < 4.0 * std::sqrt(12.0 / kPoses) / 6.0);
}

TEST_CASE("errors of twice the claimed size: NEES of 4, and the shares of the normal distribution") {
  const ConsistencyFigures figures = figures_of(draw(4.0 * some_covariance(), some_covariance()));
  CHECK(std::abs(figures.nees - 4.0) < 4.0 * 4.0 * std::sqrt(12.0 / kPoses) / 6.0);
  const double one = std::erf(0.98 / std::sqrt(2.0));  // P(|z| < 1.96 / 2)
  for (const double share : figures.within_95_component) CHECK(std::abs(share - one) < tolerance(one));
  // P(chi-squared of 6 < 12.59 / 4) = 1 - exp(-x) (1 + x + x^2 / 2) with x = 12.59 / 8.
  const double x = 12.591587 / 8.0;
  const double all = 1.0 - std::exp(-x) * (1.0 + x + 0.5 * x * x);
  CHECK(std::abs(figures.within_95 - all) < tolerance(all));
}

TEST_CASE("a wrong component is found by itself; the ellipsoids that hold it show it, the others do not") {
  Matrix6 claim = some_covariance();
  claim.row(5) *= 0.1;  // yaw is claimed ten times too well
  claim.col(5) *= 0.1;
  const ConsistencyFigures figures = figures_of(draw(some_covariance(), claim));
  CHECK(figures.within_95_component[5] < 0.2);
  CHECK(figures.within_95 < 0.3);
  CHECK(figures.within_95_orientation < 0.3);
  CHECK(std::abs(figures.within_95_position - 0.95) < tolerance(0.95));
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(std::abs(figures.within_95_component[i] - 0.95) < tolerance(0.95));
  }
}

TEST_CASE("covariances are in the estimate's frame: a frame that is turned by 90 degrees has the same NEES") {
  Run run = draw(some_covariance(), some_covariance());
  const ConsistencyFigures straight = figures_of(run);
  const Eigen::Isometry3d turn = yaw_and_shift(std::acos(0.0), {3.0, -4.0, 5.0});
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn.linear().transpose();
  for (PoseCovariance& one : run.covariances) one.covariance = both * one.covariance * both.transpose();
  const ConsistencyFigures turned = consistency_of(run.pairs, run.covariances, turn);
  CHECK(turned.nees == doctest::Approx(straight.nees).epsilon(1e-6));
  CHECK(turned.within_95 == doctest::Approx(straight.within_95));
  const ConsistencyFigures wrong = figures_of(run);
  CHECK(wrong.nees > 1.5 * straight.nees);
}

TEST_CASE("poses without a covariance are left out; a claim of certainty or nonsense counts as outside") {
  Run run = draw(some_covariance(), some_covariance());
  const ConsistencyFigures none = consistency_of(run.pairs, {}, Eigen::Isometry3d::Identity());
  CHECK(none.poses == 0);
  CHECK(std::isnan(none.nees));
  CHECK(std::isnan(none.within_95_component[2]));

  Run part = run;
  for (std::size_t i = 0; i < kPoses / 4; ++i) part.covariances[i].covariance.setZero();
  part.covariances[kPoses - 1].stamp_ns += 1'000'000;
  CHECK(figures_of(part).poses == kPoses - kPoses / 4 - 1);

  Run certain = run;
  for (PoseCovariance& one : certain.covariances) {
    one.covariance.row(2).setZero();
    one.covariance.col(2).setZero();
  }
  CHECK(figures_of(certain).within_95_component[2] < 0.01);
  CHECK(figures_of(certain).within_95 < 0.01);
  CHECK(figures_of(certain).within_95_component[0] > 0.9);

  Run nonsense = run;
  for (PoseCovariance& one : nonsense.covariances) one.covariance(0, 1) = one.covariance(1, 0) = 1.0;
  CHECK(figures_of(nonsense).poses == kPoses);
  CHECK(figures_of(nonsense).within_95 == 0.0);
  CHECK(std::isnan(figures_of(nonsense).nees));
}

TEST_CASE(
    "the longest time silently wrong ends with a pose that is right, not registered, or admits its error") {
  Run run = draw(some_covariance() * 1e-6, some_covariance());
  for (std::size_t i = 0; i < kPoses; ++i) {
    run.pairs[i].stamp_ns = run.pairs[i].estimate.stamp_ns = run.covariances[i].stamp_ns =
        100'000'000 * static_cast<std::int64_t>(i);
  }
  CHECK(figures_of(run).longest_silent_s == 0.0);
  for (std::size_t i = 100; i < 200; ++i) run.pairs[i].estimate.position_m.x() += 0.5;  // ten sigma
  CHECK(figures_of(run).longest_silent_s == doctest::Approx(9.9));
  Run said = run;
  said.covariances[130].registered = false;
  CHECK(figures_of(said).longest_silent_s == doctest::Approx(6.8));  // 131 to 199
  Run admitted = run;
  admitted.covariances[130].covariance *= 100.0;
  CHECK(figures_of(admitted).longest_silent_s == doctest::Approx(6.8));
  Run small = run;
  for (std::size_t i = 0; i < kPoses; ++i) small.covariances[i].covariance *= 1e-4;
  CHECK(figures_of(small).longest_silent_s == doctest::Approx(9.9));  // millimetres elsewhere are not "wrong"
}

TEST_CASE("evaluate() takes the covariances of a run, in its own frame, after the alignment at the start") {
  const Trajectory reference = winding(60.0, 0.05);
  Trajectory estimate = transformed(yaw_and_shift(1.2, {1, 2, 3}), reference);
  std::vector<PoseCovariance> covariances;
  Matrix6 claim = Matrix6::Identity() * 1e-6;
  claim(2, 2) = 0.01;
  for (std::size_t i = 0; i < estimate.poses.size(); ++i) {
    if (i > 0) estimate.poses[i].position_m.z() += i % 10 == 0 ? 0.25 : 0.1;  // 2.5 sigma or 1 sigma
    covariances.push_back({estimate.poses[i].stamp_ns, claim});
  }
  const MethodFigures figures = evaluate(reference, {}, estimate, {}, {}, covariances).figures;
  CHECK(figures.consistency.poses == figures.paired);
  CHECK(figures.consistency.within_95_component[2] == doctest::Approx(0.9).epsilon(0.01));
  CHECK(figures.consistency.within_95_component[0] == doctest::Approx(1.0));
}

}  // namespace isobar::test::test_consistency

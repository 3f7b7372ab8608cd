// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/squared.hpp"
#include "synthetic_drive.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_mount_estimator {

namespace {

const Eigen::Vector3d kLeft(0.0, 0.0, 45.0);
const Eigen::Vector3d kNoTurn = Eigen::Vector3d::Zero();

const Eigen::Quaterniond kConfigured(rotation_from_rpy_deg({0.0, 15.0, 5.0}));

// 100 m with two turns of 90 deg.
void hundred_metres(SyntheticDrive& robot) {
  robot.drive(40.0, 1.0, kNoTurn);
  robot.drive(2.0, 0.5, kLeft);
  robot.drive(40.0, 1.0, kNoTurn);
  robot.drive(2.0, 0.5, -kLeft);
  robot.drive(20.0, 1.0, kNoTurn);
}

// Noise of registered scans and wheels as replays of simulated robots show it.
DriveErrors usual(const Eigen::Vector3d& mount_deg) {
  return {.mount_deg = mount_deg, .scan_deg = 0.05, .position_m = 0.003};
}

}  // namespace

TEST_CASE("two turns within 100 m tell roll and pitch to 0.1 deg, straight drives tell yaw to 0.2 deg") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const double sign = seed % 2 == 0 ? 1.0 : -1.0;
    SyntheticDrive robot(kConfigured, usual({0.5 * sign, -0.8, 0.6 * sign}), seed);
    hundred_metres(robot);
    CAPTURE(seed);
    CHECK(robot.estimate().verdict == MountVerdict::kFound);
    CHECK(robot.estimate().yaw_found);
    CHECK(robot.error_deg().head<2>().cwiseAbs().maxCoeff() < 0.1);
    CHECK(std::abs(robot.error_deg().z()) < 0.2);
    CHECK(robot.estimate().outlier_share < 0.1);
  }
}

TEST_CASE("a mount that is off by 3 deg is found as well") {
  SyntheticDrive robot(kConfigured, usual({-3.0, 2.0, 2.5}), 3);
  hundred_metres(robot);
  hundred_metres(robot);
  CHECK(robot.error_deg().head<2>().cwiseAbs().maxCoeff() < 0.1);
  CHECK(std::abs(robot.error_deg().z()) < 0.2);
}

TEST_CASE("a right mount stays within its sigma in most runs, within three in all") {
  int within = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SyntheticDrive robot(kConfigured, usual(Eigen::Vector3d::Zero()), seed);
    hundred_metres(robot);
    const MountEstimate found = robot.estimate();
    const Eigen::Vector3d ratio = found.error_rad.cwiseAbs().cwiseQuotient(found.sigma_rad());
    CHECK(ratio.maxCoeff() < 3.0);
    within += static_cast<int>((ratio.array() < 1.0).count());
  }
  CHECK(within >=
        20);  // of 30; 0.68 of a normal distribution is 20, and the sigma holds systematic errors besides
}

TEST_CASE("without a turn roll and pitch stay unknown, and keep the error that hands build") {
  SyntheticDrive robot(kConfigured, usual({0.5, -0.8, 0.6}), 1);
  robot.drive(60.0, 1.0, kNoTurn);
  const MountEstimate found = robot.estimate();
  CHECK(found.verdict == MountVerdict::kUnknown);
  CHECK(found.sigma_rad().x() > 0.6 * kRadPerDeg);
  CHECK(found.sigma_rad().y() > 0.6 * kRadPerDeg);
  CHECK(found.yaw_found);
}

TEST_CASE("yaw is found without wheels by turns about an axis that is not vertical") {
  DriveErrors errors = usual({0.5, -0.8, 1.0});
  errors.wheel_distance = 0.0;  // wheels that stand still give no direction
  SyntheticDrive robot(kConfigured, errors, 4);
  for (int i = 0; i < 6; ++i) {
    robot.drive(2.0, 0.5, {0.0, -15.0, 0.0});
    robot.drive(2.0, 0.5, {0.0, 15.0, 0.0});
    robot.drive(2.0, 0.5, kLeft);
  }
  CHECK(std::abs(robot.error_deg().z()) < 0.2);
  CHECK(robot.estimate().sigma_rad().z() > 0.2 * kRadPerDeg);
  CHECK(robot.estimate().sigma_rad().z() < 0.5 * kRadPerDeg);
}

TEST_CASE("yaw of turns that tilt is not used where straight drives will tell it better") {
  for (const bool wheels : {false, true}) {
    CAPTURE(wheels);
    DriveErrors errors = usual({0.5, -0.8, 0.6});
    errors.wheels = wheels;
    SyntheticDrive robot(kConfigured, errors, 4);
    for (int i = 0; i < 9; ++i) {
      robot.drive(2.0, 0.5, {0.0, -15.0, 0.0});
      robot.drive(2.0, 0.5, {0.0, 15.0, 0.0});
      robot.drive(2.0, 0.5, kLeft);
    }
    REQUIRE(robot.estimate().sigma_rad().z() < 0.4 * kRadPerDeg);
    CHECK(robot.estimate().yaw_found != wheels);
    robot.drive(40.0, 1.0, kNoTurn);
    CHECK(robot.estimate().yaw_found);
  }
}

TEST_CASE("without wheels yaw needs turns that tilt, and roll and pitch are less certain") {
  DriveErrors hanging = usual({0.5, -0.8, 0.6});
  hanging.wheels = false;
  SyntheticDrive free(kConfigured, hanging, 4);
  SyntheticDrive wheeled(kConfigured, usual({0.5, -0.8, 0.6}), 4);
  hundred_metres(free);
  hundred_metres(wheeled);
  CHECK(free.estimate().verdict == MountVerdict::kFound);
  CHECK_FALSE(free.estimate().yaw_found);
  CHECK(free.estimate().sigma_rad().x() > 1.5 * wheeled.estimate().sigma_rad().x());
  CHECK(free.error_deg().head<2>().cwiseAbs().maxCoeff() < 0.2);
}

TEST_CASE("the estimate refers to the configured mount, whichever the registration uses meanwhile") {
  SyntheticDrive robot(kConfigured, usual({0.5, -0.8, 0.6}), 2);
  robot.drive(10.0, 1.0, kNoTurn);
  robot.drive(1.0, 0.5, kLeft);
  robot.use_mount(exp_so3(Eigen::Vector3d(0.5, -0.8, 0.6) * kRadPerDeg) * kConfigured);
  robot.drive(1.0, 0.5, kLeft);
  robot.drive(10.0, 1.0, kNoTurn);
  robot.drive(4.0, 0.5, -kLeft);
  CHECK(robot.error_deg().head<2>().cwiseAbs().maxCoeff() < 0.1);
}

TEST_CASE("a lost registration is inconsistent") {
  DriveErrors errors = usual(Eigen::Vector3d::Zero());
  errors.lost_deg_rthz = 1.5;
  SyntheticDrive robot(kConfigured, errors, 5);
  hundred_metres(robot);
  CHECK(robot.estimate().verdict == MountVerdict::kInconsistent);
}

TEST_CASE("a turn in another map frame, or while no scan is registered, is no evidence") {
  SyntheticDrive robot(kConfigured, usual({0.5, -0.8, 0.6}), 6);
  robot.drive(10.0, 1.0, kNoTurn);
  robot.next_session();
  robot.silent(true);
  robot.drive(4.0, 0.5, kLeft);
  robot.silent(false);
  robot.drive(10.0, 1.0, kNoTurn);
  CHECK(robot.estimate().verdict == MountVerdict::kUnknown);
  hundred_metres(robot);
  CHECK(robot.error_deg().head<2>().cwiseAbs().maxCoeff() < 0.1);
}

TEST_CASE("scales of the wheels are the factors that make their distance and turn right") {
  DriveErrors errors = usual(Eigen::Vector3d::Zero());
  errors.wheel_distance = 1.03;
  errors.wheel_turn = 0.9;
  SyntheticDrive robot(kConfigured, errors, 7);
  CHECK(std::isinf(robot.estimate().wheel_turn.sigma));
  hundred_metres(robot);
  for (int i = 0; i < 4; ++i) robot.drive(2.0, 0.5, kLeft);
  const MountEstimate found = robot.estimate();
  CHECK(std::abs(found.wheel_distance.scale * 1.03 - 1.0) < 0.005);
  CHECK(std::abs(found.wheel_turn.scale * 0.9 - 1.0) < 0.005);
  CHECK(found.wheel_distance.sigma < 0.01);
  CHECK(found.wheel_turn.sigma < 0.03);
}

TEST_CASE("level surfaces tell roll and pitch before the first turn, once, and turns improve on them") {
  SyntheticDrive robot(kConfigured, usual({0.5, -0.8, 0.0}), 8);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_seen = exp_so3(Eigen::Vector3d(-0.5, 0.8, 0.0) * kRadPerDeg) * up;
  robot.drive(1.0, 0.0, kNoTurn);
  const double variance = squared(0.2 * kRadPerDeg);
  const LevelEvidence level{up, up_seen, variance * Eigen::Matrix3d::Identity()};
  robot.estimator().add_level(level);
  const MountEstimate first = robot.estimate();
  CHECK(first.verdict == MountVerdict::kFound);
  CHECK(robot.error_deg().head<2>().cwiseAbs().maxCoeff() <
        0.05);  // 4 % of 0.8 deg are the share of 1 deg a priori
  robot.estimator().add_level(level);
  CHECK(robot.estimate().covariance_rad2 == first.covariance_rad2);
  hundred_metres(robot);
  CHECK(robot.estimate().sigma_rad().x() < 0.6 * first.sigma_rad().x());
}

TEST_CASE("a pose that is not finite changes nothing") {
  SyntheticDrive robot(kConfigured, usual({0.5, -0.8, 0.6}), 9);
  hundred_metres(robot);
  const Eigen::Vector3d before = robot.estimate().error_rad;
  ScanMotionEvidence broken;
  broken.T_map_base.translation().x() = std::numeric_limits<double>::quiet_NaN();
  robot.estimator().add(broken, PriorHistory(2));
  CHECK(robot.estimate().error_rad == before);
}

TEST_CASE("a scan allocates nothing") {
  SyntheticDrive robot(kConfigured, usual({0.5, -0.8, 0.6}), 10);
  const std::size_t before = allocation_count();
  hundred_metres(robot);
  CHECK(robot.estimate().yaw_found);
  CHECK(allocation_count() == before);
}

}  // namespace isobar::test::test_mount_estimator

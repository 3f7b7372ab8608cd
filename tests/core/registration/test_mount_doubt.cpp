// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <random>

#include "core/geometry.hpp"
#include "core/registration/mount_doubt.hpp"
#include "core/squared.hpp"

namespace isobar::test::test_mount_doubt {

namespace {

constexpr double kPriorRad = 0.35 * kRadPerDeg;

/// A mount that is known to 0.06 deg, yaw as well.
MountEstimate found(const Eigen::Vector3d& error_deg) {
  MountEstimate estimate;
  estimate.verdict = MountVerdict::kFound;
  estimate.error_rad = error_deg * kRadPerDeg;
  estimate.covariance_rad2 = Eigen::Matrix3d::Identity() * squared(0.06 * kRadPerDeg);
  estimate.yaw_found = true;
  return estimate;
}

/// Nothing seen yet.
MountEstimate unknown() {
  MountEstimate estimate = found(Eigen::Vector3d::Zero());
  estimate.verdict = MountVerdict::kUnknown;
  estimate.covariance_rad2 = Eigen::Matrix3d::Identity() * squared(MountFilterConfig{}.mount_sigma_rad);
  estimate.yaw_found = false;
  return estimate;
}

MountDoubt doubt_after(const MountEstimate& estimate, bool tilt_shown = true) {
  MountDoubt doubt(kPriorRad);
  doubt.learn(estimate, tilt_shown);
  return doubt;
}

}  // namespace

TEST_CASE("without evidence mounts are as doubtful as hands build them") {
  CHECK(doubt_after(unknown()).variance_rad2() == doctest::Approx(squared(kPriorRad)).epsilon(1e-9));
  CHECK(doubt_after(unknown()).yaw_rad2() == doctest::Approx(squared(kPriorRad)).epsilon(1e-9));
  MountEstimate wrong = found({3.0, 3.0, 3.0});
  wrong.verdict = MountVerdict::kInconsistent;
  CHECK(doubt_after(wrong).variance_rad2() == squared(kPriorRad));
}

TEST_CASE("one mount that is right makes the others likely, one that is off makes them doubtful") {
  CHECK(doubt_after(found({0.0, 0.0, 0.0})).variance_rad2() < 0.3 * squared(kPriorRad));
  CHECK(doubt_after(found({1.0, 0.0, 0.0})).variance_rad2() > squared(kPriorRad));
  CHECK(doubt_after(found({0.0, 0.0, 1.0})).variance_rad2() >
        doubt_after(found({1.0, 0.0, 0.0})).variance_rad2());
}

TEST_CASE("roll and pitch that gravity fixes say nothing of the mount") {
  const double yaw_only = doubt_after(found({0.0, 0.0, 0.5}), false).variance_rad2();
  CHECK(doubt_after(found({1.0, 1.0, 0.5}), false).variance_rad2() == yaw_only);
  CHECK(doubt_after(found({1.0, 1.0, 0.5})).variance_rad2() > yaw_only);
}

TEST_CASE("a yaw that is known to be wrong turns the map by as much") {
  const double rad = std::sqrt(doubt_after(found({0.0, 0.0, 0.8})).yaw_rad2());
  CHECK(rad > 0.8 * kRadPerDeg);
  CHECK(rad < 0.82 * kRadPerDeg);
  CHECK(std::sqrt(doubt_after(found({0.0, 0.0, 0.0})).yaw_rad2()) < 0.07 * kRadPerDeg);
}

TEST_CASE("over robots that are built well and badly the doubt follows the errors of the IMU's mount") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const double built_deg : {0.15, 0.35, 0.7}) {
    CAPTURE(built_deg);
    double normalised = 0.0;
    constexpr int kRobots = 2000;
    for (int i = 0; i < kRobots; ++i) {
      const auto mount = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
      const Eigen::Vector3d imu_deg = built_deg * mount();
      Eigen::Vector3d lidar_deg = built_deg * mount();
      lidar_deg.head<2>() -= imu_deg.head<2>();
      normalised +=
          squared(imu_deg.x() * kRadPerDeg) / doubt_after(found(lidar_deg)).variance_rad2() / kRobots;
    }
    CHECK(normalised > 0.3);
    CHECK(normalised < 2.0);
  }
}

}  // namespace isobar::test::test_mount_doubt

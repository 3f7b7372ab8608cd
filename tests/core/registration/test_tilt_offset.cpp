// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/geometry.hpp"
#include "core/registration/tilt_offset.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_tilt_offset {

namespace {

constexpr double kDeg = kRadPerDeg;
constexpr double kLoose = 1.0;  // variance of gravity in the prior: the map stays rigid

const Eigen::Vector3d kOffset(0.4 * kDeg, -0.5 * kDeg, 0.0);

// Drives `seconds` at 1 m/s on a rigid map that is tilted by `tilt`, at the given yaw, with 10 scans a second.
void drive(TiltOffset& filter, double yaw_rad, double seconds, const Eigen::Vector3d& tilt) {
  const Eigen::Matrix3d R_true = rotation_about_z(yaw_rad);
  const Eigen::Matrix3d R_map_base = exp_so3(tilt).toRotationMatrix() * R_true;
  // up_gravity differs from the map's up, were the map level, by the offset.
  const Eigen::Vector3d up_gravity = exp_so3(-kOffset) * R_true.transpose().col(2);
  for (int i = 0; i < static_cast<int>(10.0 * seconds); ++i) {
    filter.add(R_map_base, up_gravity, 0.1, 0.1, 1e-6, kLoose);
  }
}

}  // namespace

TEST_CASE("a straight drive cannot tell gravity's offset from a tilt of the map") {
  TiltOffset filter(0.5 * kDeg);
  // The map was made level with gravity: its tilt is the offset's, and the two cancel.
  drive(filter, 0.0, 30.0, -kOffset * -1.0);
  CHECK(filter.offset_rad().norm() < 0.02 * kDeg);
  CHECK(filter.offset_sigma_rad() == doctest::Approx(0.5 * kDeg).epsilon(0.05));
}

TEST_CASE("a quarter turn finds gravity's offset") {
  TiltOffset filter(0.5 * kDeg);
  drive(filter, 0.0, 20.0, kOffset);
  drive(filter, 0.5 * kPi, 20.0, kOffset);
  // The filter reckons with gravity's correlated error of 0.07 deg; the input has none.
  CHECK((filter.offset_rad() - kOffset).norm() < 0.12 * kDeg);
  CHECK(filter.offset_sigma_rad() < 0.2 * kDeg);
}

TEST_CASE("level surfaces at the start make the offset known before the first turn") {
  TiltOffset filter(0.5 * kDeg);
  filter.restart_on_level(Eigen::Matrix2d::Identity() * 1e-7);
  drive(filter, 0.0, 20.0, Eigen::Vector3d::Zero());
  CHECK((filter.offset_rad() - kOffset).norm() < 0.12 * kDeg);
}

TEST_CASE("a corrected mount takes its part out of the offset") {
  TiltOffset filter(0.5 * kDeg);
  filter.restart_on_level(Eigen::Matrix2d::Identity() * 1e-7);
  drive(filter, 0.0, 60.0, Eigen::Vector3d::Zero());
  const Eigen::Vector3d before = filter.offset_rad();
  filter.turn_base(-kOffset);
  CHECK((filter.offset_rad() - (before - kOffset)).norm() < 1e-12);
}

TEST_CASE("a map that follows gravity does not confirm the offset that it was made with") {
  // On one heading the tilt of the map relaxes to what the offset errs by: the offset must stay uncertain.
  TiltOffset rigid(0.5 * kDeg);
  TiltOffset following(0.5 * kDeg);
  const Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d up(0.0, 0.0, 1.0);
  for (TiltOffset* filter : {&rigid, &following})
    filter->restart_on_level(Eigen::Matrix2d::Identity() * 1e-5);
  for (int i = 0; i < 600; ++i) {
    rigid.add(R, up, 0.1, 0.1, 1e-6, kLoose);
    following.add(R, up, 0.1, 0.1, 1e-6, 1e-8);
  }
  CHECK(following.offset_sigma_rad() > 1.05 * rigid.offset_sigma_rad());
}

}  // namespace isobar::test::test_tilt_offset

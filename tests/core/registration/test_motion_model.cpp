// SPDX-License-Identifier: BSD-3-Clause
// Prediction of a scan's pose without an IMU: by the wheels' turn and way, else by the motion of the scans before.
#include <doctest/doctest.h>

#include "core/geometry.hpp"
#include "core/registration/motion_model.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_motion_model {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kScanNs = 100'000'000;
constexpr double kTurnRad = 0.06;  // a scan
constexpr double kWayM = 0.1;      // a scan, forwards

Eigen::Isometry3d step() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation_about_z(kTurnRad);
  T.translation() = Eigen::Vector3d(kWayM, 0.5 * kWayM * kTurnRad, 0.0);
  return T;
}

/// A pitched robot that drives a circle on its slope.
Eigen::Isometry3d pose(int scan) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(Eigen::Vector3d(0.0, -0.2, 0.0)).toRotationMatrix();
  for (int i = 0; i < scan; ++i) T = T * step();
  return T;
}

Prior prior_of(int scan, bool wheels) {
  Prior prior;
  prior.stamp_ns = kStart + scan * kScanNs;
  prior.velocity_valid = wheels;
  if (!wheels) return prior;
  for (int i = 0; i < scan; ++i) prior.T_odom_base = prior.T_odom_base * step();
  prior.v_base_m_s = {1.0, 0.0, 0.0};
  prior.w_base_rad_s = {0.0, 0.0, 0.6};
  return prior;
}

Prediction prediction_of(bool wheels, MotionModel& model) {
  model.start(prior_of(0, wheels));
  model.relocate(prior_of(0, wheels), pose(0));
  for (int scan = 1; scan <= 8; ++scan) model.correct(prior_of(scan, wheels), pose(scan));
  return model.predict(prior_of(9, wheels), traits_of(Method::k6Dof, HeightSource::kNone));
}

double turn_error_rad(const Prediction& prediction) {
  return rotation_angle_rad(
      Eigen::Quaterniond(prediction.T_map_base.linear().transpose() * pose(9).linear()));
}

}  // namespace

TEST_CASE("without gyro and wheels a scan is predicted from the turn and the velocity of the scans before") {
  MotionModel model{RegistrationConfig{}};
  const Prediction prediction = prediction_of(false, model);
  CHECK(turn_error_rad(prediction) < 0.01 * kTurnRad);
  CHECK((prediction.T_map_base.translation() - pose(9).translation()).norm() < 0.02);
  const ScanMotion motion = model.scan_motion(prior_of(9, false), prediction);
  CHECK_FALSE(motion.turn_known);
  CHECK(std::abs(motion.w_base_rad_s.z() - 0.6) < 0.05);
}

TEST_CASE("without a gyro the wheels predict turn and way along the robot's own axes, on a slope as well") {
  MotionModel model{RegistrationConfig{}};
  const Prediction prediction = prediction_of(true, model);
  CHECK(turn_error_rad(prediction) < 1e-6);
  CHECK((prediction.T_map_base.translation() - pose(9).translation()).norm() < 1e-6);
  CHECK(model.scan_motion(prior_of(9, true), prediction).turn_known);
  // They know the yaw, not roll and pitch.
  CHECK(prediction.deviation(2) < 0.5 * prediction.deviation(0));
}

}  // namespace isobar::test::test_motion_model

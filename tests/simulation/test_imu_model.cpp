// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/imu_model.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/geometry.hpp"
#include "simulation/route.hpp"

namespace isobar::test::test_imu_model {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

Trajectory make_rest() {
  Route route({1.0, 2.0}, 0.0, 0.7);
  route.wait(3.0);
  return Trajectory(route.samples());
}

Trajectory make_drive() {
  Route route({0.0, 0.0}, 0.0, 0.0);
  route.wait(1.0);
  route.drive({{{4.0, 0.0}}, {{4.0, 3.0}}, {{4.0, 5.0}, 1.0, 0.4, "stairs"}, {{4.0, 7.0}, 1.0}});
  std::vector<RawPose> raw = route.samples();
  add_shaking(raw, route.labels(), Random(9));
  return Trajectory(raw);
}

}  // namespace

TEST_CASE("at rest and level, the unit reads gravity upwards plus its biases") {
  ImuErrors errors;
  errors.gyro_bias_rad_s = {0.001, -0.002, 0.003};
  errors.accel_bias_m_s2 = {0.02, -0.01, 0.03};
  const Trajectory rest = make_rest();
  ImuModel imu(rest, Mount{{0.1, 0.2, 0.3}, {0.0, 0.0, 90.0}}.T_base_sensor(), errors, Random(1));
  const ImuSample sample = imu.sample(1.5);
  CHECK((sample.gyro_rad_s - errors.gyro_bias_rad_s).norm() < 1e-12);
  CHECK((sample.accel_m_s2 - errors.accel_bias_m_s2 - Vector3d(0.0, 0.0, 9.80665)).norm() < 1e-9);
}

TEST_CASE("integrating the samples of a rotated unit without errors reproduces the motion") {
  const Trajectory drive = make_drive();
  const Eigen::Isometry3d T_base_imu = Mount{{0.3, -0.1, 0.2}, {5.0, -10.0, 30.0}}.T_base_sensor();
  ImuModel imu(drive, T_base_imu, ImuErrors{}, Random(1));

  const auto pose_of_imu = [&](double t) {
    const MotionState state = drive.at(t);
    Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
    T_world_base.linear() = state.q_world_base.toRotationMatrix();
    T_world_base.translation() = state.p_world;
    return Eigen::Isometry3d(T_world_base * T_base_imu);
  };
  // Strapdown integration by the midpoint rule at 2 kHz: errors of the order of (w dt)^2 a t, far below the
  // tolerance.
  constexpr double kDt = 5e-4;
  Eigen::Quaterniond q(pose_of_imu(0.0).rotation());
  Vector3d p = pose_of_imu(0.0).translation();
  Vector3d v = Vector3d::Zero();
  double t = 0.0;
  while (t < drive.duration_s() - 1.0) {
    const ImuSample middle = imu.sample(t + 0.5 * kDt);
    const auto turn = [](const Vector3d& angle) {
      return Eigen::Quaterniond(
          Eigen::AngleAxisd(angle.norm(), angle.norm() > 0.0 ? angle.normalized() : Vector3d::UnitX()));
    };
    const Eigen::Quaterniond q_middle = q * turn(0.5 * kDt * middle.gyro_rad_s);
    const Vector3d a = q_middle * middle.accel_m_s2 - Vector3d(0.0, 0.0, 9.80665);
    p += kDt * v + 0.5 * kDt * kDt * a;
    v += kDt * a;
    q = (q * turn(kDt * middle.gyro_rad_s)).normalized();
    t += kDt;
  }
  const Eigen::Isometry3d expected = pose_of_imu(t);
  CHECK(t > 15.0);
  CHECK((p - expected.translation()).norm() < 5e-3);
  CHECK(q.angularDistance(Eigen::Quaterniond(expected.rotation())) < 1e-4);
}

TEST_CASE("white noise has the density of the data sheet") {
  ImuErrors errors;
  errors.gyro_density_rad_s_rthz = 5e-4;
  errors.accel_density_m_s2_rthz = 8e-4;
  const Trajectory rest = make_rest();
  ImuModel imu(rest, Eigen::Isometry3d::Identity(), errors, Random(2));
  // The variance of the mean over one second is density^2 / (2 * 1 s), independent of the sampling rate.
  double gyro = 0.0;
  double accel = 0.0;
  constexpr int kMeans = 400;
  constexpr int kSamples = 200;
  for (int i = 0; i < kMeans; ++i) {
    Vector3d w = Vector3d::Zero();
    Vector3d a = Vector3d::Zero();
    for (int k = 0; k < kSamples; ++k) {
      const ImuSample sample = imu.sample(1.5);
      w += sample.gyro_rad_s / kSamples;
      a += (sample.accel_m_s2 - Vector3d(0.0, 0.0, 9.80665)) / kSamples;
    }
    gyro += w.squaredNorm() / (3.0 * kMeans);
    accel += a.squaredNorm() / (3.0 * kMeans);
  }
  // 1200 values: five standard deviations of their variance are 20 %.
  CHECK(gyro == doctest::Approx(0.5 * 25e-8).epsilon(0.2));
  CHECK(accel == doctest::Approx(0.5 * 64e-8).epsilon(0.2));
}

TEST_CASE(
    "a robot in an elevator is shaken by the cabin, not by its tracks, and the cabin's vibration is no "
    "climb") {
  Route route({0.0, 0.0}, 0.0, 0.0);
  route.wait(2.0);
  route.ride(60.0, 1.0, 0.8);
  route.wait(2.0);
  const Trajectory trajectory(route.samples());
  ImuErrors errors;
  errors.vibration_m_s2 = 0.5;
  errors.cabin_vibration_m_s2 = 0.03;
  ImuModel imu(trajectory, Eigen::Isometry3d::Identity(), errors, Random(3));
  constexpr double kDt = 1.0 / ImuModel::kRateHz;
  double square = 0.0;
  double climb_m_s = 0.0;
  double climb_m = 0.0;
  for (double t = 0.0; t < trajectory.duration_s(); t += kDt) {
    const double error = imu.sample(t).accel_m_s2.z() - 9.80665 - trajectory.at(t).a_world.z();
    square += error * error * kDt;
    climb_m_s += error * kDt;
    climb_m += climb_m_s * kDt;
  }
  // 60 s at full speed of about 66 s.
  CHECK(std::abs(std::sqrt(square / 60.0) - 0.03) < 0.003);
  CHECK(std::abs(climb_m_s) < 0.001);
  // White noise of that size would be 0.5 m.
  CHECK(std::abs(climb_m) < 0.01);
}

}  // namespace isobar::test::test_imu_model

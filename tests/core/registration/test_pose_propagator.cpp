// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/registration/pose_propagator.hpp"

namespace isobar::test::test_pose_propagator {

namespace {

constexpr std::int64_t kStepNs = 5'000'000;  // 200 Hz
constexpr double kStepS = 5e-3;
constexpr int kPriorsPerScan = 20;  // 10 Hz
constexpr int kDelay = 8;           // the registration's result comes 40 ms after the scan

Eigen::Isometry3d pose_of(double x_m, double y_m, double z_m, double yaw_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

/// A robot on a circle of 5 m at 1 m/s. The only error of its wheels is a scale error.
struct Drive {
  double wheel_scale = 1.0;
  bool has_wheels = true;
  double climb_m_s = 0.0;

  [[nodiscard]] static double time_s(int step) { return step * kStepS; }
  [[nodiscard]] Eigen::Isometry3d truth(int step) const {
    const double angle = time_s(step) / 5.0;
    return pose_of(5.0 * std::sin(angle), 5.0 - 5.0 * std::cos(angle), climb_m_s * time_s(step), angle);
  }
  [[nodiscard]] Prior prior(int step) const {
    Prior prior;
    prior.stamp_ns = (step + 1) * kStepNs;
    prior.T_odom_base = truth(step);
    prior.T_odom_base.translation() *= has_wheels ? wheel_scale : 0.0;
    prior.T_odom_base.translation().z() = 0.0;  // wheels do not measure the climb of a cabin
    prior.height_m = 100.0 + climb_m_s * time_s(step);
    prior.height_variance_m2 = 1e-4;
    prior.height_source = HeightSource::kDifferential;
    prior.velocity_valid = has_wheels;
    prior.v_base_m_s = has_wheels ? Eigen::Vector3d(1.0, 0.0, 0.0) : Eigen::Vector3d::Zero();
    prior.w_base_rad_s = Eigen::Vector3d(0.0, 0.0, 0.2);
    return prior;
  }
  /// Registered pose of that step: the truth, moved by `error`.
  [[nodiscard]] PoseEstimate registered(
      int step, const Eigen::Isometry3d& error = Eigen::Isometry3d::Identity()) const {
    PoseEstimate pose;
    pose.stamp_ns = (step + 1) * kStepNs;
    pose.mode = PoseMode::kRegistered;
    pose.height_source = HeightSource::kDifferential;
    pose.T_map_base = error * truth(step);
    pose.T_map_odom = pose.T_map_base * prior(step).T_odom_base.inverse();
    pose.covariance = 1e-4 * Matrix6d::Identity();
    return pose;
  }
};

/// Runs `steps` priors with a registration every scan, and hands each result to `check(step, odometry)`.
template <class Check>
void run(const Drive& drive, int steps, Check&& check, PosePropagatorConfig config = {}) {
  PosePropagator propagator(config);
  for (int step = 0; step < steps; ++step) {
    Odometry odometry;
    if (propagator.propagate(drive.prior(step), odometry)) {
      check(step, odometry);
    }
    if (step >= kDelay && (step - kDelay) % kPriorsPerScan == 0) {
      propagator.add_pose(drive.registered(step - kDelay));
    }
  }
}

TEST_CASE("there is no odometry before the first registered pose") {
  PosePropagator propagator;
  Odometry odometry;
  CHECK_FALSE(propagator.propagate(Drive{}.prior(0), odometry));
  CHECK_FALSE(propagator.propagate(Drive{}.prior(1), odometry));
  propagator.add_pose(Drive{}.registered(1));
  CHECK(propagator.propagate(Drive{}.prior(2), odometry));
}

TEST_CASE("map to odom times odom to base is the best pose, also with a wrong wheel scale") {
  int count = 0;
  run(Drive{.wheel_scale = 1.1}, 2000, [&](int, const Odometry& odometry) {
    const Eigen::Isometry3d product = odometry.T_map_odom * odometry.T_odom_base;
    CHECK((product.matrix() - odometry.T_map_base.matrix()).norm() < 1e-9);  // rounding
    ++count;
  });
  CHECK(count > 1900);
}

TEST_CASE("with perfect dead reckoning the best pose is the truth and map to odom stays the identity") {
  const Drive drive;
  run(drive, 4000, [&](int step, const Odometry& odometry) {
    CHECK((odometry.T_map_base.matrix() - drive.truth(step).matrix()).norm() < 1e-9);
    CHECK((odometry.T_map_odom.matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-9);
  });
}

TEST_CASE("odometry follows the registered pose while dead reckoning drifts by metres") {
  // 10 % of scale at 1 m/s: dead reckoning is wrong by metres; between registrations (0.1 s and 40 ms of
  // delay) the best pose is wrong by up to 14 mm, and odom lags behind it by the error's rate times the time
  // constant.
  const Drive drive{.wheel_scale = 1.1};
  double worst_odom_m = 0.0;
  double worst_dead_reckoning_m = 0.0;
  run(drive, 4000, [&](int step, const Odometry& odometry) {
    const Eigen::Vector3d truth = drive.truth(step).translation();
    worst_odom_m = std::max(worst_odom_m, (odometry.T_odom_base.translation() - truth).norm());
    const Eigen::Vector3d xy = drive.prior(step).T_odom_base.translation();
    worst_dead_reckoning_m = std::max(worst_dead_reckoning_m, (xy - truth).norm());
  });
  CHECK(worst_dead_reckoning_m > 0.9);
  CHECK(worst_odom_m < 0.014 + 0.1 * 0.1 + 0.01);
}

TEST_CASE("a jump of the registration enters odom at the slew rate at most, and completely") {
  const Drive drive;
  const PosePropagatorConfig config;
  const Eigen::Isometry3d jump = pose_of(0.6, -0.3, 0.0, 0.2);
  PosePropagator propagator(config);
  Odometry before;
  Odometry now;
  propagator.add_pose(drive.registered(0));
  REQUIRE(propagator.propagate(drive.prior(1), before));
  propagator.add_pose(drive.registered(1, jump));
  for (int step = 2; step < 2000; ++step, before = now) {
    REQUIRE(propagator.propagate(drive.prior(step), now));
    const Eigen::Isometry3d T_before_now = before.T_odom_base.inverse() * now.T_odom_base;
    const Eigen::Isometry3d T_truth = drive.truth(step - 1).inverse() * drive.truth(step);
    const Eigen::Isometry3d extra = T_truth.inverse() * T_before_now;
    // The rotation during the step turns the correction, by a fraction of a thousandth.
    CHECK(extra.translation().norm() <= config.max_slew_m_s * kStepS * 1.001 + 1e-12);
    CHECK(Eigen::AngleAxisd(extra.linear()).angle() <= config.max_slew_rad_s * kStepS + 1e-9);
  }
  CHECK((now.T_map_base.matrix() - (jump * drive.truth(1999)).matrix()).norm() < 1e-9);
  CHECK((now.T_map_odom.matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-6);  // exp(-100) and rounding
}

TEST_CASE("a robot that turns out to be elsewhere has not driven there: odom goes on, map to odom jumps") {
  for (const Eigen::Isometry3d& jump : {pose_of(20.0, -7.0, 0.0, 1.0), pose_of(0.2, 0.1, 0.0, 2.5)}) {
    const Drive drive;
    PosePropagator propagator;
    Odometry before;
    Odometry now;
    propagator.add_pose(drive.registered(0));
    REQUIRE(propagator.propagate(drive.prior(1), before));
    // The pose of a scan 40 ms ago.
    for (int step = 2; step < 2 + kDelay; ++step) REQUIRE(propagator.propagate(drive.prior(step), before));
    propagator.add_pose(drive.registered(2, jump));
    for (int step = 2 + kDelay; step < 400; ++step, before = now) {
      REQUIRE(propagator.propagate(drive.prior(step), now));
      const Eigen::Isometry3d T_truth = drive.truth(step - 1).inverse() * drive.truth(step);
      CHECK((before.T_odom_base.inverse() * now.T_odom_base * T_truth.inverse())
                .isApprox(Eigen::Isometry3d::Identity(), 1e-9));
      CHECK((now.T_map_base.matrix() - (jump * drive.truth(step)).matrix()).norm() < 1e-9);
      CHECK((now.T_map_odom.matrix() - jump.matrix()).norm() < 1e-6);
    }
  }
}

TEST_CASE("a map that is moved by centimetres takes the robot along: odom goes on, map to odom jumps") {
  const Eigen::Isometry3d moved = pose_of(0.08, -0.03, 0.02, 0.01);
  for (const bool has_wheels : {true, false}) {
    const Drive drive{.has_wheels = has_wheels};
    PosePropagator propagator;
    Odometry before;
    Odometry now;
    for (int step = 0; step < 600; ++step, before = now) {
      const bool is_moved = step >= 300 + kDelay;
      if (step >= kDelay && (step - kDelay) % kPriorsPerScan == 0) {
        PoseEstimate pose = drive.registered(step - kDelay, is_moved ? moved : Eigen::Isometry3d::Identity());
        pose.map_moves = is_moved ? 1 : 0;
        propagator.add_pose(pose);
      }
      const bool known = propagator.propagate(drive.prior(step), now);
      if (!known || step < 200) continue;
      // Without wheels the straight extrapolation over 40 ms leaves the circle by less than a millimetre, and the next
      // pose brings it back within 20 priors: a few hundredths of a millimetre a step. The jump is 86 mm.
      const Eigen::Isometry3d T_truth = drive.truth(step - 1).inverse() * drive.truth(step);
      const Eigen::Isometry3d extra = before.T_odom_base.inverse() * now.T_odom_base * T_truth.inverse();
      CHECK(extra.translation().norm() < (has_wheels ? 1e-9 : 1e-3));
      CHECK(Eigen::AngleAxisd(extra.linear()).angle() < 1e-6);
    }
    CHECK((now.T_map_odom.translation() - moved.translation()).norm() < (has_wheels ? 1e-6 : 5e-3));
  }
}

TEST_CASE("in an elevator the height between scans is the altimeter's") {
  const Drive drive{.climb_m_s = 1.5};
  run(drive, 1000, [&](int step, const Odometry& odometry) {
    CHECK(odometry.T_map_base.translation().z() == doctest::Approx(1.5 * Drive::time_s(step)).epsilon(1e-9));
  });
}

TEST_CASE("in method odometry the height between poses is dead reckoning's, not the altimeter's") {
  // A cabin that climbs to 1 m: the altimeter sees it, wheels and hence the poses of this method do not.
  const Drive drive{.climb_m_s = 1.0};
  PosePropagator propagator;
  Odometry odometry;
  static_cast<void>(propagator.propagate(drive.prior(0), odometry));
  static_cast<void>(propagator.propagate(drive.prior(1), odometry));
  PoseEstimate pose = drive.registered(0);
  pose.method = pose.effective_method = Method::kOdometry;
  pose.mode = PoseMode::kPriorOnly;
  propagator.add_pose(pose);
  REQUIRE(propagator.propagate(drive.prior(200), odometry));
  CHECK(odometry.T_map_base.translation().z() == doctest::Approx(0.0).epsilon(1e-9));
  CHECK(odometry.T_odom_base.translation().z() == doctest::Approx(0.0).epsilon(1e-9));
}

TEST_CASE("on moving ground the height between poses is the altimeter's in 4-DOF too") {
  const Drive drive{.climb_m_s = 1.0};
  PosePropagator propagator;
  Odometry odometry;
  static_cast<void>(propagator.propagate(drive.prior(0), odometry));
  static_cast<void>(propagator.propagate(drive.prior(1), odometry));
  PoseEstimate pose = drive.registered(0);
  pose.method = pose.effective_method = Method::k4Dof;
  pose.mode = PoseMode::kPriorOnly;
  pose.lost = LostReason::kMovingGround;
  propagator.add_pose(pose);
  REQUIRE(propagator.propagate(drive.prior(200), odometry));
  CHECK(odometry.T_map_base.translation().z() == doctest::Approx(Drive::time_s(200)).epsilon(1e-6));
}

TEST_CASE("without wheels the velocity between the last scans is extrapolated for a limited time") {
  const Drive drive{.has_wheels = false};
  // The circle departs from the straight line by v w t^2 / 2 and the velocity is that of 0.05 s before the
  // scan: at 0.14 s after it 1 m/s * 0.2 rad/s * (0.14^2 / 2 + 0.05 * 0.14) m = 3.4 mm.
  run(drive, 2000, [&](int step, const Odometry& odometry) {
    if (step > 2 * kPriorsPerScan + kDelay) {
      CHECK((odometry.T_map_base.translation() - drive.truth(step).translation()).norm() < 3.4e-3);
      CHECK((odometry.v_base_m_s - Eigen::Vector3d(1.0, 0.0, 0.0)).norm() < 0.05);
    }
  });

  PosePropagator propagator;
  Odometry odometry;
  static_cast<void>(propagator.propagate(drive.prior(0), odometry));
  propagator.add_pose(drive.registered(1));
  propagator.add_pose(drive.registered(21));
  REQUIRE(propagator.propagate(drive.prior(21 + 400), odometry));  // 2 s without a scan
  const double moved_m = (odometry.T_map_base.translation() - drive.truth(21).translation()).head<2>().norm();
  CHECK(moved_m == doctest::Approx(0.5).epsilon(0.01));  // half a second at 1 m/s
  CHECK(odometry.v_base_m_s.isZero());
}

TEST_CASE("variances grow with the age of the registered pose") {
  Drive drive;
  PosePropagator propagator;
  propagator.add_pose(drive.registered(0));
  Odometry odometry;
  double last = 1e-4;
  for (int step = 1; step < 100; ++step) {
    Prior prior = drive.prior(step);
    prior.velocity_variance_m2_s2 = 0.01;
    REQUIRE(propagator.propagate(prior, odometry));
    CHECK(odometry.pose_covariance(0, 0) > last);
    last = odometry.pose_covariance(0, 0);
  }
  const double age_s = 99 * kStepS;
  CHECK(last == doctest::Approx(1e-4 + 0.01 * age_s * age_s));
  CHECK(odometry.twist_covariance(0, 0) == 0.01);
}

TEST_CASE("priors and poses that are not finite or go back in time are ignored") {
  const Drive drive;
  PosePropagator propagator;
  propagator.add_pose(drive.registered(0));
  Odometry odometry;
  REQUIRE(propagator.propagate(drive.prior(5), odometry));
  CHECK_FALSE(propagator.propagate(drive.prior(5), odometry));
  CHECK_FALSE(propagator.propagate(drive.prior(4), odometry));
  Prior broken = drive.prior(6);
  broken.T_odom_base.translation().x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(propagator.propagate(broken, odometry));
  PoseEstimate bad = drive.registered(6);
  bad.T_map_odom.translation().y() = std::numeric_limits<double>::infinity();
  propagator.add_pose(bad);
  REQUIRE(propagator.propagate(drive.prior(7), odometry));
  CHECK((odometry.T_map_base.matrix() - drive.truth(7).matrix()).norm() < 1e-9);
}

}  // namespace

TEST_CASE("odom is continuous when a new map frame begins, even if its clock starts over") {
  for (const bool clock_starts_over : {false, true}) {
    CAPTURE(clock_starts_over);
    const Drive drive;
    PosePropagator propagator;
    Odometry before;
    propagator.add_pose(drive.registered(0));
    for (int step = 1; step < 400; ++step) {
      if (step % kPriorsPerScan == 0) propagator.add_pose(drive.registered(step));
      propagator.propagate(drive.prior(step), before);
    }
    const std::int64_t back_ns = clock_starts_over ? 399 * kStepNs : 0;
    // The new frame begins at the robot, at another yaw.
    const Eigen::Isometry3d T_new_old = drive.truth(400).inverse();
    Odometry after;
    for (int step = 400; step < 460; ++step) {
      PoseEstimate pose = drive.registered(step, T_new_old);
      pose.session = 2;
      pose.stamp_ns -= back_ns;
      if (step % kPriorsPerScan == 0) propagator.add_pose(pose);
      Prior prior = drive.prior(step);
      prior.stamp_ns -= back_ns;
      REQUIRE(propagator.propagate(prior, after));
      CHECK(after.session == 2);
      // 1 m/s for 5 ms, and the slewing of corrections of the new frame, of which there are none.
      CHECK((after.T_odom_base.translation() - before.T_odom_base.translation()).norm() < 0.012);
      CHECK((after.T_map_odom * after.T_odom_base).isApprox(after.T_map_base, 1e-9));
      before = after;
    }
    CHECK((after.T_map_base.translation() - (T_new_old * drive.truth(459)).translation()).norm() < 1e-6);
  }
}

}  // namespace isobar::test::test_pose_propagator

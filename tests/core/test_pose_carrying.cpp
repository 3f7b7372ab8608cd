// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/pose_carrying.hpp"

namespace isobar::test::test_pose_carrying {

TEST_CASE("the midpoint step along an arc is its chord's direction and has third-order error") {
  // Arc of radius v / w from yaw 0.3: displacement (v / w) (sin(yaw + w t) - sin(yaw), cos(yaw) - cos(yaw + w
  // t)).
  const double v_m_s = 1.2;
  const double w_rad_s = 0.9;
  const double dt_s = 0.05;
  const double yaw = 0.3;
  const double end = yaw + w_rad_s * dt_s;
  const Eigen::Vector3d expected =
      v_m_s / w_rad_s * Eigen::Vector3d(std::sin(end) - std::sin(yaw), std::cos(yaw) - std::cos(end), 0.0);
  const Eigen::Vector3d step_base(v_m_s * dt_s, 0.0, 0.0);
  const Eigen::Vector3d half_turn(0.0, 0.0, 0.5 * w_rad_s * dt_s);
  const double tolerance_m = v_m_s * w_rad_s * w_rad_s * dt_s * dt_s * dt_s / 24.0 * 1.01;
  const Eigen::Vector3d from_start = midpoint_step(exp_so3({0.0, 0.0, yaw}), half_turn, step_base);
  const Eigen::Vector3d from_end = midpoint_step(exp_so3({0.0, 0.0, end}), -half_turn, step_base);
  CHECK((from_start - expected).norm() < tolerance_m);
  CHECK((from_end - from_start).norm() < 1e-15);
}

TEST_CASE("a carried pose is T_map_base(then) T_odom_base(then)^-1 T_odom_base(now)") {
  const auto pose = [](const Eigen::Vector3d& rpy, const Eigen::Vector3d& p) {
    Eigen::Isometry3d T(rotation_from_rpy(rpy));
    T.translation() = p;
    return T;
  };
  const Eigen::Isometry3d T_map_base = pose({0.1, -0.2, 1.0}, {3.0, -2.0, 0.5});
  const Eigen::Isometry3d T_odom_then = pose({0.1, -0.2, -2.0}, {70.0, 20.0, 0.0});
  const Eigen::Isometry3d T_odom_now = pose({0.05, 0.1, -1.8}, {70.5, 20.3, 0.1});
  const PoseAnchor anchor(T_map_base, T_odom_then);
  const Eigen::Isometry3d expected = T_map_base * T_odom_then.inverse() * T_odom_now;
  CHECK((anchor.carried_to(T_odom_now).matrix() - expected.matrix()).norm() < 1e-13);
  CHECK((T_map_base.translation() + anchor.step_map_m(T_odom_now) - expected.translation()).norm() < 1e-13);
  CHECK((anchor.carried_to(T_odom_then).matrix() - T_map_base.matrix()).norm() < 1e-15);
}

}  // namespace isobar::test::test_pose_carrying

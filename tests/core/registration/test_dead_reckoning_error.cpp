// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/registration/dead_reckoning_error.hpp"

namespace isobar::test::test_dead_reckoning_error {

namespace {

Prior wheels_at(double speed_m_s) {
  Prior prior;
  prior.attitude_valid = prior.velocity_valid = true;
  prior.v_base_m_s.x() = speed_m_s;
  prior.standing_still = speed_m_s == 0.0;
  prior.yaw_rate_variance_rad2_s2 = 2e-3 * 2e-3;
  prior.yaw_bias_variance_rad2_s2 = 1e-3 * 1e-3;
  return prior;
}

/// `seconds` straight on, at a speed along x.
DeadReckoningError driven(const Prior& prior, double seconds, DeadReckoningError error = {}) {
  UnseenStep step;
  step.dt_s = 0.1;
  step.step_m.x() = 0.1 * prior.v_base_m_s.x();
  for (int i = 0; i < static_cast<int>(std::lround(10.0 * seconds)); ++i) error.move(prior, step);
  return error;
}

double sd(const DeadReckoningError& error, int row) { return std::sqrt(error.covariance()(row, row)); }

}  // namespace

TEST_CASE(
    "wheels: a standing robot stays known, a driving one errs by a share of the way, and across by yaw") {
  CHECK(driven(wheels_at(0.0), 100.0).covariance().norm() == 0.0);
  const DeadReckoningError near = driven(wheels_at(1.0), 25.0);
  const DeadReckoningError far = driven(wheels_at(1.0), 100.0);
  CHECK(sd(near, 0) > 0.01 * 25.0);
  CHECK(sd(far, 0) > 3.0 * sd(near, 0));
  CHECK(sd(far, 0) < 0.03 * 100.0);
  CHECK(sd(far, 1) > 10.0 * sd(near, 1));  // rate x time x way
  CHECK(sd(far, 5) > 0.02);
}

TEST_CASE("without wheels the position is lost with time; at first it is that of the last velocity") {
  Prior blind = wheels_at(0.0);
  blind.velocity_valid = blind.standing_still = false;
  blind.velocity_variance_m2_s2 = 0.5 * 0.5;
  CHECK(sd(driven(blind, 0.1), 0) < 0.05);
  CHECK(sd(driven(blind, 10.0), 0) > 2.0);
  CHECK(sd(driven(blind, 100.0), 0) < 20.0);
  DeadReckoningError fast;
  fast.restart({3.0, 0.0, 0.0});
  CHECK(sd(driven(blind, 10.0, fast), 0) > 2.0 * sd(driven(blind, 10.0), 0));
}

TEST_CASE(
    "without IMU and wheels yaw is soon unknown, and a yaw that is unknown is no larger than a turn; wheels "
    "alone know it as their rate says") {
  Prior blind = wheels_at(1.0);
  blind.attitude_valid = false;
  blind.yaw_bias_variance_rad2_s2 = 0.05 * 0.05;
  CHECK(sd(driven(blind, 1.0), 5) > 0.04);
  CHECK(sd(driven(blind, 1.0), 5) < 0.06);
  blind.velocity_valid = false;
  CHECK(sd(driven(blind, 1.0), 5) > 0.3);
  CHECK(sd(driven(blind, 100.0), 5) <= 3.01);
}

TEST_CASE("a scan ends it") {
  DeadReckoningError error = driven(wheels_at(1.0), 10.0);
  CHECK(error.way_m() == doctest::Approx(10.0));
  error.restart();
  CHECK(error.covariance().norm() == 0.0);
  CHECK(error.way_m() == 0.0);
}

}  // namespace isobar::test::test_dead_reckoning_error

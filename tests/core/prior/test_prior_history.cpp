// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/prior/prior_history.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_prior_history {

namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Constant twist: the exact motion at time t.
Prior at_time(std::int64_t stamp_ns) {
  const double t = static_cast<double>(stamp_ns) * 1e-9;
  Prior prior;
  prior.stamp_ns = stamp_ns;
  prior.w_base_rad_s = {0.0, 0.0, 0.5};
  prior.v_base_m_s = {1.0, 0.0, 0.0};
  prior.T_odom_base.linear() = exp_so3(prior.w_base_rad_s * t).toRotationMatrix();
  prior.T_odom_base.translation() =
      Eigen::Vector3d(2.0 * std::sin(0.5 * t), 2.0 * (1.0 - std::cos(0.5 * t)), 0.0);
  prior.height_m = 0.3 * t;
  prior.attitude_valid = true;
  prior.height_source = HeightSource::kDifferential;
  return prior;
}

}  // namespace

TEST_CASE("a history interpolates a constant twist") {
  PriorHistory history(100);
  for (int i = 0; i < 60; ++i) history.add(at_time(i * 5 * kMs));
  for (std::int64_t stamp = 0; stamp <= 295 * kMs; stamp += 1'234'567) {
    Prior prior;
    REQUIRE(history.at(stamp, prior));
    const Prior truth = at_time(stamp);
    CHECK(prior.stamp_ns == stamp);
    // Chord against arc over 5 ms: v w dt^2 / 8, 1.6e-6 m.
    CHECK((prior.T_odom_base.translation() - truth.T_odom_base.translation()).norm() < 2e-6);
    CHECK(prior.T_odom_base.linear().isApprox(truth.T_odom_base.linear(), 1e-12));
    CHECK(prior.height_m == doctest::Approx(truth.height_m).epsilon(1e-12));
  }
}

TEST_CASE("a history extrapolates by the twist, up to its limit") {
  PriorHistory history(10, 100 * kMs);
  for (int i = 0; i < 20; ++i) history.add(at_time(i * 5 * kMs));
  Prior prior;
  REQUIRE(history.at(195 * kMs, prior));
  // Over 100 ms the straight step differs from the arc by v w^2 dt^3 / 24.
  CHECK((prior.T_odom_base.translation() - at_time(195 * kMs).T_odom_base.translation()).norm() < 2e-5);
  CHECK(prior.T_odom_base.linear().isApprox(at_time(195 * kMs).T_odom_base.linear(), 1e-12));
  // The height keeps its own rate: the twist has no vertical speed (elevator).
  CHECK(prior.height_m == doctest::Approx(0.3 * 0.195).epsilon(1e-6));
  const Prior untouched = prior;
  CHECK_FALSE(history.at(196 * kMs, prior));
  CHECK(prior.stamp_ns == untouched.stamp_ns);
}

TEST_CASE(
    "a full history overwrites the oldest prior; queries before it and priors out of order are refused") {
  PriorHistory history(10);
  Prior prior;
  CHECK_FALSE(history.at(0, prior));
  for (int i = 0; i < 25; ++i) history.add(at_time(i * 5 * kMs));
  CHECK(history.oldest().stamp_ns == 75 * kMs);
  CHECK(history.newest().stamp_ns == 120 * kMs);
  CHECK_FALSE(history.at(75 * kMs - 1, prior));
  CHECK(history.at(75 * kMs, prior));
  history.add(at_time(60 * kMs));
  CHECK(history.newest().stamp_ns == 120 * kMs);
}

TEST_CASE("an interpolated prior has the worse of two height sources, and only the flags that both have") {
  Prior a = at_time(0);
  Prior b = at_time(10 * kMs);
  b.height_source = HeightSource::kHeld;
  b.attitude_valid = false;
  PriorHistory history(2);
  history.add(a);
  history.add(b);
  Prior middle;
  REQUIRE(history.at(3 * kMs, middle));
  CHECK(middle.height_source == HeightSource::kHeld);
  CHECK_FALSE(middle.attitude_valid);
}

}  // namespace isobar::test::test_prior_history

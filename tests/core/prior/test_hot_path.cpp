// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstring>
#include <new>

#include "core/prior/prior_history.hpp"
#include "tests/core/prior/simulated_robot.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_hot_path {

TEST_CASE("nothing is allocated after construction") {
  PriorConfig config;
  config.compensation.model = CompensationModel::kOffset;
  config.compensation.coefficients.assign(16, 0.0);
  config.compensation.coefficients[0] = config.compensation.pressure_centre_pa + 12.0;
  config.compensation.coefficients[4] = config.compensation.pressure_scale_pa;
  config.compensation.range = {90'000.0, 99'999.0, 0.0, 10.0};
  PriorEstimator estimator{config};
  PriorHistory history(256);
  Prior prior;
  const std::size_t before = allocation_count();
  bool covered = true;
  for (int i = 0; i < 4000; ++i) {
    const std::int64_t stamp_ns = i * 5'000'000LL;
    ImuSample sample;
    sample.stamp_ns = stamp_ns;
    sample.accel_m_s2 = Eigen::Vector3d(0.01 * (i % 7), 0.0, kGravity);
    if (i % 6 == 0) estimator.add_pressure({stamp_ns, 1e5 + 0.1 * (i % 5), 20.0});
    if (i % 6 == 3) estimator.add_base_pressure({stamp_ns, 1e5 + 0.1 * (i % 3), 20.0});
    if (i % 4 == 0) estimator.add_wheel({stamp_ns, 0.3, 0.0, 0.0});
    estimator.add_imu(sample, prior);
    history.add(prior);
    covered = covered && history.at(stamp_ns - (i > 0 ? 1'000'000 : 0), prior);
  }
  CHECK(allocation_count() == before);
  CHECK(covered);
  CHECK(estimator.counters().pressure_outside_calibration > 0);
  const std::size_t counted = allocation_count();
  ::operator delete(::operator new(16));  // the counter works; a new-expression might be optimised away
  CHECK(allocation_count() == counted + 1);
}

TEST_CASE("the same samples give the same bits") {
  SimulatedRobot robot;
  robot.motion = Drive{};
  robot.duration_s = 10.0;
  const auto first = run(robot, config_for(robot), 12);
  const auto second = run(robot, config_for(robot), 12);
  REQUIRE(first.size() == second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(std::memcmp(first[i].prior.T_odom_base.data(), second[i].prior.T_odom_base.data(),
                      16 * sizeof(double)) == 0);
    CHECK(first[i].prior.height_m == second[i].prior.height_m);
    CHECK(first[i].prior.height_variance_m2 == second[i].prior.height_variance_m2);
  }
}

}  // namespace isobar::test::test_hot_path

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/prior/prior_estimator.hpp"

namespace isobar::test::test_bad_input {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool finite(const Prior& prior) {
  return prior.T_odom_base.matrix().allFinite() && std::isfinite(prior.height_m) &&
         std::isfinite(prior.height_variance_m2) && prior.height_variance_m2 >= 0.0 &&
         prior.v_base_m_s.allFinite() && prior.w_base_rad_s.allFinite() &&
         std::isfinite(prior.roll_pitch_variance_rad2);
}

struct Bench {
  PriorEstimator estimator{PriorConfig{}};
  std::mt19937 random{21};
  std::normal_distribution<double> normal{0.0, 1.0};
  Prior prior;
  std::int64_t now_ns = 1'700'000'000'000'000'000;

  ImuSample imu() {
    ImuSample sample;
    sample.stamp_ns = now_ns;
    sample.gyro_rad_s.setConstant(0.001 * normal(random));
    sample.accel_m_s2 = Eigen::Vector3d(0.02 * normal(random), 0.0, kGravity + 0.02 * normal(random));
    return sample;
  }
  PressureSample pressure() { return {now_ns - 1'000'000, 1e5 + 0.3 * normal(random), 20.0}; }
  void stand(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 200.0); ++i) {
      now_ns += 5'000'000;
      if (i % 6 == 0) {
        estimator.add_base_pressure(pressure());
        estimator.add_pressure(pressure());
      }
      if (i % 4 == 0) estimator.add_wheel({now_ns - 500'000, 0.0, 0.0, 0.0});
      CHECK(estimator.add_imu(imu(), prior));
      CHECK(finite(prior));
    }
  }
};

}  // namespace

TEST_CASE("broken samples are counted and change nothing") {
  Bench bench;
  bench.stand(5.0);
  const Prior before = bench.prior;
  Prior out = before;
  ImuSample imu = bench.imu();
  imu.stamp_ns += 1;
  imu.gyro_rad_s.x() = kNan;
  CHECK_FALSE(bench.estimator.add_imu(imu, out));
  imu = bench.imu();
  imu.stamp_ns += 1;
  imu.accel_m_s2.z() = 1e5;
  CHECK_FALSE(bench.estimator.add_imu(imu, out));
  CHECK_FALSE(bench.estimator.add_imu(bench.imu(), out));  // the same time again
  imu = bench.imu();
  imu.stamp_ns -= 1'000'000'000;
  CHECK_FALSE(bench.estimator.add_imu(imu, out));
  for (const std::int64_t stamp :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    imu = bench.imu();
    imu.stamp_ns = stamp;
    CHECK_FALSE(bench.estimator.add_imu(imu, out));
    bench.estimator.add_wheel({stamp, 0.0, 0.0, 0.0});
    bench.estimator.add_pressure({stamp, 1e5, 20.0});
    bench.estimator.add_base_pressure({stamp, 1e5, 20.0});
  }
  bench.estimator.add_pressure({bench.now_ns, kNan, 20.0});
  bench.estimator.add_pressure({bench.now_ns, 1e5 + 5000.0, 20.0});
  bench.estimator.add_base_pressure({bench.now_ns, -3.0, 20.0});
  bench.estimator.add_wheel({bench.now_ns, kNan, 0.0, 0.0});
  bench.estimator.add_wheel({bench.now_ns, 1e9, 0.0, 0.0});
  CHECK(out.stamp_ns == before.stamp_ns);
  const PriorCounters& counters = bench.estimator.counters();
  CHECK(counters.imu_bad_value == 2);
  CHECK(counters.imu_bad_time == 4);
  CHECK(counters.pressure_bad_value == 2);
  CHECK(counters.pressure_bad_time == 2);
  CHECK(counters.base_bad_value == 1);
  CHECK(counters.base_bad_time == 2);
  CHECK(counters.wheel_bad_value == 2);
  CHECK(counters.wheel_bad_time == 2);
  const double height = bench.prior.height_m;
  bench.stand(5.0);
  CHECK(std::abs(bench.prior.height_m - height) < 0.02);
}

TEST_CASE("pressure spikes of thousands of pascals do not move the height") {
  Bench bench;
  bench.stand(5.0);
  for (int i = 0; i < 20; ++i) {
    bench.estimator.add_pressure({bench.now_ns, 1e5 + (i % 2 == 0 ? 3000.0 : -2500.0), 20.0});
    bench.stand(0.1);
    CHECK(std::abs(bench.prior.height_m) < 0.03);
  }
  CHECK(bench.estimator.counters().pressure_bad_value == 20);
}

TEST_CASE("a barometer stuck at one value is lost and its height held") {
  Bench bench;
  bench.stand(5.0);
  CHECK(bench.prior.height_source == HeightSource::kDifferential);
  for (int i = 0; i < 1000; ++i) {
    bench.now_ns += 5'000'000;
    bench.estimator.add_pressure({bench.now_ns, 100'000.25, 20.0});
    bench.estimator.add_wheel({bench.now_ns, 0.0, 0.0, 0.0});
    bench.estimator.add_imu(bench.imu(), bench.prior);
  }
  CHECK(bench.prior.height_source == HeightSource::kHeld);
  CHECK(bench.estimator.counters().pressure_repeated == 999);
  bench.stand(2.0);
  CHECK(bench.prior.height_source == HeightSource::kDifferential);
}

TEST_CASE("one stamp from the far future is refused, a confirmed jump of the clock is followed") {
  for (const std::int64_t jump_ns : {3'600'000'000'000LL, -3'600'000'000'000LL}) {
    Bench bench;
    bench.stand(5.0);
    ImuSample imu = bench.imu();
    imu.stamp_ns += jump_ns;
    CHECK_FALSE(bench.estimator.add_imu(imu, bench.prior));
    bench.stand(1.0);
    CHECK(bench.prior.attitude_valid);
    bench.now_ns += jump_ns;
    CHECK_FALSE(bench.estimator.add_imu(bench.imu(), bench.prior));
    bench.stand(5.0);
    CHECK(bench.estimator.counters().imu_restarts == 1);
    CHECK(bench.prior.attitude_valid);
    CHECK(bench.prior.height_source == HeightSource::kDifferential);
    CHECK(std::abs(bench.prior.height_m) < 0.05);
  }
}

TEST_CASE("shocks, saturation and free fall leave the estimate finite and it recovers") {
  Bench bench;
  bench.stand(5.0);
  for (int i = 0; i < 400; ++i) {
    bench.now_ns += 5'000'000;
    ImuSample sample = bench.imu();
    sample.accel_m_s2 =
        Eigen::Vector3d(150.0 * bench.normal(bench.random), 0.0, 0.0).cwiseMax(-150.0).cwiseMin(150.0);
    sample.gyro_rad_s = Eigen::Vector3d(0.0, 3.0 * bench.normal(bench.random), 0.0);
    if (bench.estimator.add_imu(sample, bench.prior)) CHECK(finite(bench.prior));
  }
  bench.stand(30.0);
  const Eigen::Vector3d up = bench.prior.T_odom_base.linear().row(2);
  CHECK(up.z() > std::cos(0.03));
  CHECK(std::abs(bench.prior.height_m) < 0.3);
}

TEST_CASE("random garbage never gives a prior that is not finite") {
  std::mt19937_64 random(77);
  PriorEstimator estimator{PriorConfig{}};
  const auto any = [&]() {
    const double scale[] = {0.0, 1e-300, 1.0, 10.0, 1e5, 1e18, 1e300, kNan};
    return scale[random() % 8] * (static_cast<double>(random() % 2001) / 1000.0 - 1.0);
  };
  std::int64_t now_ns = 0;
  Prior prior;
  for (int i = 0; i < 100'000; ++i) {
    now_ns += static_cast<std::int64_t>(random() % 20'000'000);
    const std::int64_t stamp_ns = random() % 50 == 0 ? static_cast<std::int64_t>(random()) : now_ns;
    switch (random() % 4) {
      case 0: {
        ImuSample sample;
        sample.stamp_ns = stamp_ns;
        sample.gyro_rad_s = Eigen::Vector3d(any(), any(), any());
        sample.accel_m_s2 =
            random() % 2 == 0 ? Eigen::Vector3d(any(), any(), any()) : Eigen::Vector3d(0.0, 0.0, 9.8);
        if (random() % 2 == 0) sample.gyro_rad_s.setZero();
        if (estimator.add_imu(sample, prior)) REQUIRE(finite(prior));
        break;
      }
      case 1:
        estimator.add_pressure({stamp_ns, random() % 3 == 0 ? any() : 1e5 + 0.001 * any(), any()});
        break;
      case 2:
        estimator.add_base_pressure({stamp_ns, random() % 3 == 0 ? any() : 1e5 + 0.001 * any(), any()});
        break;
      default:
        estimator.add_wheel({stamp_ns, any(), any(), any()});
    }
  }
  CHECK(estimator.counters().imu_accepted > 1000);
}

TEST_CASE("an accelerometer in g is refused and counted, and the attitude waits for one in m/s^2") {
  Bench bench;
  for (int i = 0; i < 400; ++i) {  // 2 s
    bench.now_ns += 5'000'000;
    ImuSample sample = bench.imu();
    sample.accel_m_s2 /= kGravity;
    bench.estimator.add_imu(sample, bench.prior);
  }
  CHECK_FALSE(bench.prior.attitude_valid);
  CHECK(bench.estimator.counters().imu_wrong_gravity >= 3);  // one every 0.5 s
  bench.stand(1.0);
  CHECK(bench.prior.attitude_valid);
}

}  // namespace isobar::test::test_bad_input

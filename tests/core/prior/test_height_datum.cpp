// SPDX-License-Identifier: BSD-3-Clause
// The height datum over a restart.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "core/prior/prior_estimator.hpp"
#include "core/samples.hpp"

namespace isobar::test::test_height_datum {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
constexpr std::int64_t kNightNs = 36'000'000'000'000;
// Near 20 °C and 1000 hPa a metre is 11.6 Pa.
constexpr double kPaPerM = 11.6;

/// A robot that stands: pressures at its place and at the base station's, with noise of 0.3 Pa.
struct Standing {
  double robot_pa = 100'900.0;
  double base_pa = 100'950.0;
  double base_from_s = 0.0;  ///< the base station is heard from then on
  double seconds = 30.0;
  double climb_m_s = 0.0;  ///< of the robot and of what it stands on
  bool wheels = false;     ///< that stand
};

/// The last prior of the estimator. Its height must not leave `limit_m` around `expected_m` once it is known.
Prior stand(PriorEstimator& estimator, const Standing& at, std::int64_t begin_ns, double expected_m,
            double limit_m) {
  std::mt19937 random{3};
  std::normal_distribution<double> noise(0.0, 1.0);
  Prior prior;
  const auto steps = static_cast<int>(at.seconds * 100.0);
  for (int i = 0; i < steps; ++i) {
    const std::int64_t stamp_ns = begin_ns + i * std::int64_t{10'000'000};
    if (i % 3 == 0) {
      PressureSample sample{stamp_ns, at.base_pa + 0.3 * noise(random), 20.0};
      if (i >= at.base_from_s * 100.0) estimator.add_base_pressure(sample);
      sample.pressure_pa = at.robot_pa - kPaPerM * at.climb_m_s * 0.01 * i + 0.3 * noise(random);
      estimator.add_pressure(sample);
    }
    ImuSample imu;
    imu.stamp_ns = stamp_ns;
    for (int axis = 0; axis < 3; ++axis) imu.gyro_rad_s[axis] = 0.001 * noise(random);
    imu.accel_m_s2 = {0.01 * noise(random), 0.01 * noise(random), kGravity + 0.01 * noise(random)};
    if (at.wheels && i % 5 == 0) estimator.add_wheel({stamp_ns, 0.0, 0.0, 0.0});
    if (estimator.add_imu(imu, prior) && prior.height_source != HeightSource::kNone) {
      CHECK(std::abs(prior.height_m - expected_m - at.climb_m_s * 0.01 * i) < limit_m);
    }
  }
  return prior;
}

/// Datum of a run that stood at height 0 for half a minute.
HeightDatum first_run(double base_from_s = 0.0) {
  PriorEstimator estimator{PriorConfig{}};
  const Prior last = stand(estimator, {.base_from_s = base_from_s}, kStartNs, 0.0, 0.2);
  CHECK(last.height_source != HeightSource::kNone);
  return estimator.height_datum();
}

}  // namespace

TEST_CASE("with the base station the height continues, whatever the weather did overnight") {
  const HeightDatum datum = first_run();
  REQUIRE(datum.known);
  REQUIRE(datum.station_known[0]);
  PriorEstimator next{PriorConfig{}};
  next.resume(datum);
  const Standing morning{.robot_pa = 100'900.0 - 1'500.0, .base_pa = 100'950.0 - 1'500.0};
  // 15 hPa of weather are 130 m. The offset of 50 Pa between the sensors changes its height by 1.5 %: 6 cm.
  const Prior last = stand(next, morning, kStartNs + kNightNs, 0.0, 0.2);
  CHECK(last.height_source == HeightSource::kDifferential);
}

TEST_CASE("the height of a robot that was taken to another floor is the pressure's") {
  const HeightDatum datum = first_run();
  PriorEstimator next{PriorConfig{}};
  next.resume(datum);
  const Standing above{.robot_pa = 100'900.0 - 3.5 * kPaPerM};
  stand(next, above, kStartNs + kNightNs, 3.5, 0.3);
}

TEST_CASE("a height that was not 0 is continued, and so is the datum of a third run") {
  HeightDatum datum = first_run();
  datum.height_m += 12.0;
  const Standing above{.robot_pa = 100'900.0 - 12.0 * kPaPerM};
  for (int morning = 1; morning <= 3; ++morning) {
    PriorEstimator next{PriorConfig{}};
    next.resume(datum);
    stand(next, above, kStartNs + morning * kNightNs, 12.0, 0.3);
    datum = next.height_datum();
  }
}

TEST_CASE("a robot that is killed while it climbs continues at the height where it has climbed to") {
  struct Ride {
    double climb_m_s;
    bool wheels, seen;
  };
  // A rope, a ride that had begun before, one that began while nobody looked.
  for (const Ride& ride : {Ride{-0.4, false, true}, Ride{1.0, true, true}, Ride{1.0, true, false}}) {
    CAPTURE(ride.climb_m_s);
    CAPTURE(ride.seen);
    HeightDatum datum = first_run();
    const std::int64_t begin_ns = datum.stamp_ns + 1'000'000'000;
    const double unseen_m = ride.climb_m_s * 1.0;
    if (ride.seen) datum.climb_m_s = ride.climb_m_s;
    datum.ground_moves = ride.seen && ride.wheels;
    PriorEstimator next{PriorConfig{}};
    next.resume(datum);
    const Standing riding{.robot_pa = 100'900.0 - kPaPerM * unseen_m,
                          .seconds = 6.0,
                          .climb_m_s = ride.climb_m_s,
                          .wheels = ride.wheels};
    // The first pressures have 3 cm of noise and a filter's delay; a speed that is not known shows after a second.
    stand(next, riding, begin_ns, unseen_m, ride.seen ? 0.35 : 0.8);
  }
}

TEST_CASE("without a base station the robot stands at the height where it was") {
  for (const double base_from_s : {0.0, 1e9}) {
    const HeightDatum datum = first_run(base_from_s);
    PriorEstimator next{PriorConfig{}};
    next.resume(datum);
    const Standing morning{
        .robot_pa = 100'900.0 - 1'500.0, .base_pa = 100'950.0 - 1'500.0, .base_from_s = 1e9};
    const Prior last = stand(next, morning, kStartNs + kNightNs, 0.0, 0.3);
    CHECK(last.height_source == HeightSource::kSingleBarometer);
  }
}

TEST_CASE("a robot that was taken to another floor waits for a base station whose network comes late") {
  const HeightDatum datum = first_run();
  PriorEstimator next{PriorConfig{}};
  next.resume(datum);
  const Standing above{
      .robot_pa = 100'900.0 - 1'500.0 - 3.5 * kPaPerM, .base_pa = 100'950.0 - 1'500.0, .base_from_s = 8.0};
  const Prior last = stand(next, above, kStartNs + kNightNs, 3.5, 0.3);
  CHECK(last.height_source == HeightSource::kDifferential);
}

TEST_CASE("a base station that is heard later confirms the height without a jump") {
  const HeightDatum datum = first_run();
  PriorEstimator next{PriorConfig{}};
  next.resume(datum);
  const Standing morning{
      .robot_pa = 100'900.0 - 1'500.0, .base_pa = 100'950.0 - 1'500.0, .base_from_s = 10.0};
  const Prior last = stand(next, morning, kStartNs + kNightNs, 0.0, 0.3);
  CHECK(last.height_source == HeightSource::kDifferential);
}

}  // namespace isobar::test::test_height_datum

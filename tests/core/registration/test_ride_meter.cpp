// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <type_traits>

#include "core/registration/ride_meter.hpp"

namespace isobar::test::test_ride_meter {

namespace {

constexpr double kDtS = 0.005;
constexpr double kAccelBias = 0.04;  // 4 mg and the tilt of the IMU

// A ride of 10 m: in 2 s up to 1 m/s with finite jerk, 8 s at constant speed, and in 2 s down to rest.
double speed(double t) {
  const double w = std::numbers::pi / 2.0;
  if (t <= 0.0 || t >= 12.0) return 0.0;
  const double ramp_s = t < 2.0 ? t : std::min(2.0, 12.0 - t);
  return 0.5 * (1.0 - std::cos(w * ramp_s));
}

struct Air {
  double piston_s = 0.0;  // altimeter's error per m/s of climb [s]
  double zone_m = 0.0;    // of the arrival
  double scale = 0.0;     // of every height
};

struct Sensors {
  double noise_m_s2 = 0.02;
  double gap_at_s = 1e9;  // nothing from the accelerometer for 0.3 s
};

// A robot in front of an elevator and in it.
class Robot {
 public:
  explicit Robot(const Air& air, const Sensors& sensors = {}) : air_(air), sensors_(sensors) {}

  void rest(double time_s) { run(time_s, true, false, nullptr); }
  // Drives: shakes, and the altimeter wanders.
  void drive(double time_s) { run(time_s, false, false, nullptr); }
  // Recognised 0.8 s after its start and ended 1.5 s after the stop, in `direction` +1 or -1.
  void ride(double direction) {
    run(until_s_, true, true, [direction](double t) { return direction * speed(t); });
    if (until_s_ > 13.0) meter.end();
  }
  void ride_until(double time_s) { until_s_ = time_s; }

  RideMeter meter;

 private:
  template <class Speed>
  void run(double time_s, bool stands, bool rides, Speed speed_at) {
    double before_m_s = 0.0;
    double risen_m = 0.0;
    for (double t = 0.0; t < time_s; t += kDtS, ++step_) {
      double v = 0.0;
      if constexpr (!std::is_same_v<Speed, std::nullptr_t>) v = speed_at(t);
      const double accel = (v - before_m_s) / kDtS;
      before_m_s = v;
      risen_m += v * kDtS;
      height_m_ += v * kDtS;
      const double shaking = stands ? sensors_.noise_m_s2 : 0.5;
      const double reading = accel + kAccelBias + shaking * white_(random_);
      const bool silent = rides && t >= sensors_.gap_at_s && t < sensors_.gap_at_s + 0.3;
      if (silent && gap_s_ == 0.0) gap_s_ = 0.3;
      if (!silent && gap_s_ > 0.0) {
        meter.forget(gap_s_);
        gap_s_ = 0.0;
      }
      if (!silent) meter.add_acceleration(reading, kDtS, stands);
      if (step_ % 6 == 0) {
        const double error_m = air_.piston_s * v + air_.zone_m * risen_m / 10.0 + air_.scale * height_m_;
        meter.add_altimeter(100.0 + height_m_ + error_m + 0.03 * white_(random_), 0.0009);
      }
      if (rides && !meter.riding() && t >= 0.8) meter.begin();
    }
  }

  Air air_;
  Sensors sensors_;
  std::mt19937 random_{7};
  std::normal_distribution<double> white_{0.0, 1.0};
  double height_m_ = 0.0;
  double gap_s_ = 0.0;
  double until_s_ = 13.5;
  int step_ = 0;
};

// A ride of +10 m with a rest of `rest_s` before it.
RideMeter ride(double rest_s, const Air& air, const Sensors& sensors = {}) {
  Robot robot(air, sensors);
  robot.rest(rest_s);
  robot.ride(1.0);
  return robot.meter;
}

}  // namespace

TEST_CASE("a ride between two stops is known to centimetres, whatever the pressure in the cabin does") {
  // 0.02 m/s^2 of vibration: 2 cm over 14 s between two known speeds. The altimeter is off by 0.12 m at full speed and by
  // 0.3 m upstairs. The rest is no longer than the doors take to close.
  for (const double rest_s : {1.5, 3.6, 10.0}) {
    CAPTURE(rest_s);
    const RideMeter meter = ride(rest_s, {.piston_s = 0.12, .zone_m = 0.3});
    CHECK(std::abs(meter.risen_m() - 10.0) < 0.05);
    CHECK(std::sqrt(meter.variance_m2()) < 0.08);
    CHECK(std::abs(meter.altimeter_gain_m() - 0.3) < 0.1);
  }
}

TEST_CASE("a bias learnt at an earlier rest serves a ride that begins without one") {
  Robot robot({.zone_m = 0.3});
  robot.rest(8.0);
  robot.drive(60.0);
  robot.ride(1.0);
  CHECK(std::abs(robot.meter.risen_m() - 10.0) < 0.1);
}

TEST_CASE("on a ride without any rest the altimeter says how far it went") {
  // No rest to learn the bias of the accelerometer from: 0.04 m/s^2 alone would be 2.9 m.
  const RideMeter meter = ride(0.0, {});
  CHECK(std::abs(meter.risen_m() - 10.0) < 0.25);
}

TEST_CASE("a base station outdoors does not stretch a ride, and the error of its air is learnt") {
  Robot robot({.scale = 0.05});
  robot.rest(4.0);
  robot.ride(1.0);
  CHECK(std::abs(robot.meter.risen_m() - 10.0) < 0.06);
  const double first_sd = robot.meter.air_scale_sd();
  for (const double direction : {-1.0, 1.0, -1.0}) {
    robot.rest(4.0);
    robot.ride(direction);
    CHECK(std::abs(robot.meter.risen_m() - direction * 10.0) < 0.06);
  }
  CHECK(robot.meter.air_scale_sd() < first_sd);
  CHECK(std::abs(robot.meter.air_scale() - 0.05) < 0.02);
}

TEST_CASE("the more the cabin shakes the less the acceleration is believed") {
  const double quiet = ride(4.0, {}).variance_m2();
  const RideMeter shaking = ride(4.0, {}, {.noise_m_s2 = 0.5});
  CHECK(shaking.variance_m2() > 4.0 * quiet);
  // 0.5 m/s^2 at 200 Hz leaves 0.5 m of acceleration alone; the altimeter holds it to its own 0.2 m.
  CHECK(std::abs(shaking.risen_m() - 10.0) < 0.3);
}

TEST_CASE("a cabin at full speed has not stopped, one at rest may have") {
  Robot robot({.zone_m = 0.3});
  robot.rest(4.0);
  robot.ride_until(7.0);
  robot.ride(1.0);
  CHECK(robot.meter.riding());
  CHECK_FALSE(robot.meter.may_have_stopped());
  Robot stopped({.zone_m = 0.3});
  stopped.rest(4.0);
  stopped.ride_until(12.9);
  stopped.ride(1.0);
  CHECK(stopped.meter.riding());
  CHECK(stopped.meter.may_have_stopped());
}

TEST_CASE("in the middle of a ride the height is that of now, not of the last whole interval") {
  // 1 m/s: half an interval of 50 ms would be 2.5 cm.
  for (const double extra_s : {0.0, 0.01, 0.02, 0.03, 0.04}) {
    CAPTURE(extra_s);
    Robot robot({}, {.noise_m_s2 = 0.005});
    robot.rest(4.0);
    robot.ride_until(6.0 + extra_s);
    robot.ride(1.0);
    CHECK(std::abs(robot.meter.risen_m() - (5.0 + extra_s)) < 0.015);
  }
}

TEST_CASE("a gap of the accelerometer costs a ride decimetres at most, and says so") {
  const RideMeter meter = ride(4.0, {}, {.gap_at_s = 6.0});
  CHECK(std::abs(meter.risen_m() - 10.0) < 0.3);
  // The stop at the end tells what speed the gap has added; what is left is the way within it.
  CHECK(std::sqrt(meter.variance_m2()) > 1.1 * std::sqrt(ride(4.0, {}).variance_m2()));
}

TEST_CASE("a memory that holds a rest and the start of the ride is enough, one of the ride alone is not") {
  Robot robot({});
  robot.rest(1.2);
  robot.ride_until(0.7);
  robot.ride(1.0);
  CHECK(robot.meter.remembers_start());
  Robot late({});
  late.ride_until(0.7);
  late.ride(1.0);
  CHECK_FALSE(late.meter.remembers_start());
}

TEST_CASE("the end of a ride needs no ride") {
  RideMeter meter;
  meter.end();
  CHECK_FALSE(meter.riding());
  CHECK(meter.risen_m() == 0.0);
}

}  // namespace isobar::test::test_ride_meter

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/registration/ride_meter.hpp"

namespace isobar::test::test_ride_meter {

namespace {

constexpr double kDtS = 0.005;
constexpr double kAccelBias = 0.04;  // 4 mg and the tilt of the IMU

// A ride of 10 m: 1 m/s^2 up to 1 m/s, 9 s at constant speed, and 1 m/s^2 down to rest.
double acceleration(double t) {
  if (t >= 0.0 && t < 1.0) return 1.0;
  return t >= 10.0 && t < 11.0 ? -1.0 : 0.0;
}
double height(double t) {
  t = std::clamp(t, 0.0, 11.0);
  const double up = std::min(t, 1.0);
  const double down = std::max(t - 10.0, 0.0);
  return 0.5 * up * up + std::max(t - 1.0, 0.0) - 0.5 * down * down;
}

struct Air {
  double piston_s = 0.0;  // altimeter's error per m/s of climb [s]
  double zone_m = 0.0;    // of the arrival
};

// Rides with a rest of `rest_s` before it; the ride is recognised a second after its start.
RideMeter ride(double rest_s, const Air& air, double noise_m_s2) {
  RideMeter meter;
  std::mt19937 random(7);
  std::normal_distribution<double> white(0.0, 1.0);
  double speed_m_s = 0.0;
  int step = 0;
  for (double t = -rest_s; t < 12.0; t += kDtS, ++step) {
    const double a = acceleration(t);
    speed_m_s += a * kDtS;
    meter.add_acceleration(a + kAccelBias + noise_m_s2 * white(random), kDtS, true);
    if (step % 6 == 0) {
      const double error_m = air.piston_s * speed_m_s + air.zone_m * height(t) / 10.0;
      meter.add_altimeter(100.0 + height(t) + error_m + 0.03 * white(random), 0.0009);
    }
    if (!meter.riding() && t >= 1.0) meter.begin();
  }
  meter.end();
  return meter;
}

}  // namespace

TEST_CASE("a ride between two stops is known to centimetres, whatever the pressure in the cabin does") {
  // 14 mg/sqrt(Hz) of vibration over 12 s between two known speeds: 2 cm. The altimeter is off by 0.12 m at full speed
  // and by 0.3 m upstairs.
  const RideMeter meter = ride(4.0, {.piston_s = 0.12, .zone_m = 0.3}, 0.04);
  CHECK(meter.risen_m() == doctest::Approx(10.0).epsilon(0.006));
  CHECK(std::sqrt(meter.variance_m2()) < 0.08);
}

TEST_CASE("on a ride without a rest before it the altimeter says how far it went") {
  // No rest to learn the bias of the accelerometer from: 0.04 m/s^2 alone would be 2.9 m.
  const RideMeter meter = ride(0.0, {}, 0.04);
  CHECK(std::abs(meter.risen_m() - 10.0) < 0.25);
}

TEST_CASE("the more the cabin shakes the less the acceleration is believed") {
  const double quiet = ride(4.0, {}, 0.04).variance_m2();
  const double shaking = ride(4.0, {}, 0.5).variance_m2();
  CHECK(shaking > 4.0 * quiet);
  // 0.5 m/s^2 at 200 Hz leaves 0.5 m of acceleration alone; the altimeter holds it to its own 0.2 m.
  CHECK(std::abs(ride(4.0, {}, 0.5).risen_m() - 10.0) < 0.3);
}

TEST_CASE("the end of a ride needs no ride") {
  RideMeter meter;
  meter.end();
  CHECK_FALSE(meter.riding());
  CHECK(meter.risen_m() == 0.0);
}

}  // namespace isobar::test::test_ride_meter

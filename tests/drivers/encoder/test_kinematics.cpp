// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "drivers/encoder/kinematics.hpp"

namespace isobar::test::test_kinematics {

using namespace isobar::encoder;

namespace {

constexpr Geometry kRobot{
    .wheel_radius_m = 0.1, .counts_per_turn = 2'000.0, .track_width_m = 0.5, .track_factor = 1.6};
constexpr double kTurnM = 0.2 * std::numbers::pi;

Geometry with(Drive drive) {
  Geometry geometry = kRobot;
  geometry.drive = drive;
  return geometry;
}

}  // namespace

TEST_CASE("one turn of both wheels in a second is the wheel's circumference per second, straight on") {
  for (const Drive drive : {Drive::kDifferential, Drive::kSkidSteer, Drive::kTracked}) {
    const WheelSample ahead = twist(with(drive), 2'000.0, 2'000.0, 1.0);
    CHECK(ahead.vx_m_s == doctest::Approx(kTurnM));
    CHECK(ahead.vy_m_s == 0.0);
    CHECK(ahead.wz_rad_s == 0.0);
    CHECK(twist(with(drive), -1'000.0, -1'000.0, 0.5).vx_m_s == doctest::Approx(-kTurnM));
  }
}

TEST_CASE("the right wheel alone turns the robot left about the left wheel") {
  const WheelSample arc = twist(with(Drive::kDifferential), 0.0, 2'000.0, 1.0);
  CHECK(arc.wz_rad_s == doctest::Approx(kTurnM / 0.5));
  // The middle of the axle moves on a circle of half the track.
  CHECK(arc.vx_m_s == doctest::Approx(arc.wz_rad_s * 0.25));
}

TEST_CASE("a turn in place of a skid-steered robot is smaller by the factor of its track") {
  const double plain = twist(with(Drive::kDifferential), -500.0, 500.0, 1.0).wz_rad_s;
  CHECK(twist(with(Drive::kSkidSteer), -500.0, 500.0, 1.0).wz_rad_s == doctest::Approx(plain / 1.6));
  CHECK(twist(with(Drive::kTracked), -500.0, 500.0, 1.0).wz_rad_s == doctest::Approx(plain / 1.6));
  CHECK(effective_track_m(with(Drive::kDifferential)) == 0.5);
}

TEST_CASE("the way of a drive in a circle, integrated from samples, closes") {
  const double dt_s = 0.02;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading = 0.0;
  // Right 60, left 40 counts a sample: a radius of 1.25 m.
  const WheelSample sample = twist(with(Drive::kDifferential), 40.0, 60.0, dt_s);
  CHECK(sample.vx_m_s / sample.wz_rad_s == doctest::Approx(1.25));
  const auto samples = static_cast<int>(std::lround(2.0 * std::numbers::pi / (sample.wz_rad_s * dt_s)));
  for (int i = 0; i < samples; ++i) {
    heading += 0.5 * sample.wz_rad_s * dt_s;
    x_m += sample.vx_m_s * dt_s * std::cos(heading);
    y_m += sample.vx_m_s * dt_s * std::sin(heading);
    heading += 0.5 * sample.wz_rad_s * dt_s;
  }
  CHECK(std::hypot(x_m, y_m) < 0.02);  // half a sample's way
}

}  // namespace isobar::test::test_kinematics

// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/input_check.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "tests/core/contradictions/room.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_input_check {

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

/// What goes wrong in a drive of 20 s in the room: a circle of 0.6 m at 0.5 m/s.
struct Faults {
  std::function<void(ImuSample&)> imu = [](ImuSample& /*sample*/) {};
  std::function<void(WheelSample&)> wheel = [](WheelSample& /*sample*/) {};
  bool with_wheels = true;
};

constexpr double kSpeedMS = 0.5;
double turn_rate(double t) { return t < 2.0 ? 0.0 : 0.4 * std::sin(0.5 * t); }

std::unique_ptr<InputCheck> drive(const Faults& faults) {
  auto check = std::make_unique<InputCheck>(InputCheckConfig{});
  const auto scan = std::make_unique<Scan>();
  Eigen::Isometry2d T_room_base = Eigen::Isometry2d::Identity();
  for (int i = 0; i <= 4000; ++i) {
    const double t = 0.005 * i;
    const std::int64_t stamp_ns = kStart + i * 5'000'000LL;
    const double speed_m_s = t < 2.0 ? 0.0 : kSpeedMS * std::cos(0.35 * t);
    ImuSample imu;
    imu.stamp_ns = stamp_ns;
    imu.gyro_rad_s.z() = turn_rate(t);
    imu.accel_m_s2 = Eigen::Vector3d(0.0, speed_m_s * turn_rate(t), kGravity);
    faults.imu(imu);
    check->add_imu(imu);
    if (i % 4 == 0 && faults.with_wheels) {
      WheelSample wheel{.stamp_ns = stamp_ns, .vx_m_s = speed_m_s, .wz_rad_s = turn_rate(t)};
      faults.wheel(wheel);
      check->add_wheel(wheel);
    }
    // The scan is that of its middle.
    if (i % 20 == 0) {
      scan_room({}, T_room_base, Eigen::Matrix3d::Identity(), stamp_ns + 50'000'000, *scan);
      check->add_scan(*scan);
    }
    T_room_base.translate(Eigen::Vector2d(0.005 * speed_m_s, 0.0));
    T_room_base.rotate(0.005 * turn_rate(t));
  }
  return check;
}

Contradiction only_kind(const Faults& faults) {
  const Findings findings = drive(faults)->find();
  CAPTURE(findings.all().size());
  REQUIRE(findings.all().size() == 1);
  return findings.all()[0].kind;
}

}  // namespace

TEST_CASE("a drive whose sensors agree contradicts nothing, at any time, nor do its clocks") {
  const auto check = drive({});
  Findings findings = check->find();
  check->add_clocks(findings);
  check->add_overlaps(findings);
  CHECK(findings.empty());
  CHECK(check->turns_known());
  CHECK(drive({.with_wheels = false})->find().empty());
}

TEST_CASE("an IMU that is upside down is told apart from accelerations that are negated by the gyro") {
  CHECK(only_kind({.imu = [](ImuSample& s) {
          s.gyro_rad_s = Eigen::Vector3d(s.gyro_rad_s.x(), -s.gyro_rad_s.y(), -s.gyro_rad_s.z());
          s.accel_m_s2 = Eigen::Vector3d(s.accel_m_s2.x(), -s.accel_m_s2.y(), -s.accel_m_s2.z());
        }}) == Contradiction::kImuMount);
  CHECK(only_kind({.imu = [](ImuSample& s) { s.accel_m_s2 *= -1.0; }}) == Contradiction::kAccelNegated);
}

TEST_CASE("each fault alone is the finding, with wheels and without") {
  const auto degrees = [](ImuSample& s) { s.gyro_rad_s *= 57.29578; };
  CHECK(only_kind({.imu = degrees}) == Contradiction::kGyroUnit);
  CHECK(only_kind({.imu = degrees, .with_wheels = false}) == Contradiction::kGyroUnit);
  CHECK(only_kind({.imu = [](ImuSample& s) { s.gyro_rad_s.z() *= -1.0; }}) == Contradiction::kGyroMirrored);
  CHECK(only_kind({.imu = [](ImuSample& s) { s.accel_m_s2 /= kGravity; }}) == Contradiction::kAccelUnit);
  CHECK(only_kind({.wheel = [](WheelSample& s) { s.vx_m_s *= 3.6; }}) == Contradiction::kWheelUnit);
  CHECK(only_kind({.wheel = [](WheelSample& s) { s.wz_rad_s *= -1.0; }}) ==
        Contradiction::kWheelTurnReversed);
}

TEST_CASE("samples allocate nothing") {
  const auto check = drive({});
  const auto scan = std::make_unique<Scan>();
  scan_room({}, Eigen::Isometry2d::Identity(), Eigen::Matrix3d::Identity(), kStart + 21'000'000'000, *scan);
  const std::size_t before = allocation_count();
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t stamp_ns = kStart + 20'000'000'000 + i * 5'000'000LL;
    check->add_imu({.stamp_ns = stamp_ns});
    check->add_wheel({.stamp_ns = stamp_ns});
    check->add_pressure({.stamp_ns = stamp_ns, .pressure_pa = 101e3});
    check->add_base_pressure({.stamp_ns = stamp_ns, .pressure_pa = 101e3});
  }
  check->add_scan(*scan);
  CHECK(allocation_count() == before);
}

}  // namespace isobar::test::test_input_check

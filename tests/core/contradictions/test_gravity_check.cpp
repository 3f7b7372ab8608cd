// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/gravity_check.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "core/geometry.hpp"

namespace isobar::test::test_gravity_check {

namespace {

constexpr std::int64_t kStepNs = 5'000'000;

/// Seconds of a constant specific force in base axes, by an IMU with this true mount.
GravityCheck after(double seconds, const Eigen::Vector3d& configured_rpy_deg,
                   const Eigen::Vector3d& true_rpy_deg, const Eigen::Vector3d& force_base) {
  GravityCheck check(configured_rpy_deg);
  ImuSample sample;
  sample.accel_m_s2 = rotation_from_rpy_deg(true_rpy_deg).transpose() * force_base;
  for (std::int64_t t = 0; t <= static_cast<std::int64_t>(seconds * 1e9); t += kStepNs) {
    sample.stamp_ns = 1'000'000'000 + t;
    check.add(sample);
  }
  return check;
}

const Eigen::Vector3d kUp(0.0, 0.0, kGravity);

}  // namespace

TEST_CASE("each of the 24 right-angled mounts is found again up to its yaw, which gravity does not tell") {
  for (const double roll : {0.0, 90.0, 180.0, -90.0}) {
    for (const double pitch : {0.0, 90.0, -90.0}) {
      for (const double yaw : {0.0, 90.0, 180.0, -90.0}) {
        const Eigen::Vector3d truth(roll, pitch, yaw);
        const Eigen::Vector3d up_imu = rotation_from_rpy_deg(truth).transpose() * Eigen::Vector3d::UnitZ();
        const Eigen::Vector3d found = right_angled_mount(up_imu, 30.0);
        CHECK(found.z() == 30.0);
        CHECK((rotation_from_rpy_deg(found) * up_imu).z() == doctest::Approx(1.0));
      }
    }
  }
}

TEST_CASE("an IMU upside down is told after two seconds, with the mount that would fit") {
  CHECK_FALSE(after(1.5, {0, 0, 0}, {180, 0, 0}, kUp).mount());
  const GravityCheck check = after(2.1, {0, 0, 0}, {180, 0, 0}, kUp);
  const auto finding = check.mount();
  REQUIRE(finding);
  CHECK(finding->measured == doctest::Approx(180.0));
  CHECK(finding->remedy == std::array<double, 3>{180.0, 0.0, 0.0});
  CHECK(check.points_down());
}

TEST_CASE("an IMU on its side is told, and its configured yaw is kept") {
  const GravityCheck check = after(3.0, {0, 0, 45}, {90, 0, 45}, kUp);
  const auto finding = check.mount();
  REQUIRE(finding);
  CHECK(finding->remedy == std::array<double, 3>{90.0, 0.0, 45.0});
  CHECK_FALSE(check.points_down());
}

TEST_CASE("a mount that is configured as it is contradicts nothing, whatever it is") {
  CHECK_FALSE(after(6.0, {180, 0, 90}, {180, 0, 90}, kUp).mount());
  CHECK_FALSE(after(6.0, {0, 90, 0}, {0, 90, 0}, kUp).mount());
}

TEST_CASE(
    "a start in motion on a slope is no wrong mount: 20 deg and 3 m/s^2 together tilt gravity by less than "
    "45") {
  const Eigen::Vector3d slope = rotation_from_rpy_deg({0, 20, 0}).transpose() * kUp;
  const GravityCheck check = after(6.0, {0, 0, 0}, {0, 0, 0}, slope + Eigen::Vector3d(-3.0, 0.0, 0.0));
  CHECK(check.settled());
  CHECK_FALSE(check.mount());
  CHECK_FALSE(check.unit());
}

TEST_CASE("a robot that is set upright while it starts contradicts nothing") {
  GravityCheck check({0, 0, 0});
  ImuSample sample;
  for (int i = 0; i < 1000; ++i) {
    sample.stamp_ns = 1'000'000'000 + i * kStepNs;
    sample.accel_m_s2 = i < 400 ? Eigen::Vector3d(kGravity, 0, 0) : kUp;
    check.add(sample);
  }
  CHECK_FALSE(check.mount());
}

TEST_CASE("one upright second among five takes the finding back, though their mean is tilted by 67 deg") {
  GravityCheck check({0, 0, 0});
  ImuSample sample;
  for (int i = 0; i <= 1000; ++i) {
    sample.stamp_ns = 1'000'000'000 + i * kStepNs;
    sample.accel_m_s2 = rotation_from_rpy_deg({i < 800 ? 80.0 : 0.0, 0, 0}) * kUp;
    check.add(sample);
  }
  CHECK(check.settled());
  CHECK_FALSE(check.mount());
}

TEST_CASE("a robot that falls over after the first seconds contradicts nothing") {
  GravityCheck check({0, 0, 0});
  ImuSample sample;
  for (int i = 0; i < 4000; ++i) {
    sample.stamp_ns = 1'000'000'000 + i * kStepNs;
    sample.accel_m_s2 = i < 1400 ? kUp : Eigen::Vector3d(0, kGravity, 0);
    check.add(sample);
  }
  CHECK_FALSE(check.mount());
}

TEST_CASE("acceleration in g is told, and its direction is judged all the same") {
  const auto unit = after(3.0, {0, 0, 0}, {0, 0, 0}, kUp / kGravity).unit();
  REQUIRE(unit);
  CHECK(unit->measured == doctest::Approx(1.0));
  CHECK(after(3.0, {0, 0, 0}, {180, 0, 0}, kUp / kGravity).mount());
  CHECK_FALSE(after(3.0, {0, 0, 0}, {0, 0, 0}, kUp).unit());
}

TEST_CASE("values that are no gravity and no numbers tell nothing") {
  CHECK_FALSE(after(3.0, {0, 0, 0}, {180, 0, 0}, 30.0 * kUp).mount());
  CHECK_FALSE(after(3.0, {0, 0, 0}, {180, 0, 0}, kUp * std::nan("")).mount());
}

}  // namespace isobar::test::test_gravity_check

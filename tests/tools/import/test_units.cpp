// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/geometry.hpp"
#include "tools/import/import_plan.hpp"
#include "tools/import/scan_files.hpp"
#include "tools/import/topic_mounts.hpp"
#include "tools/import/unit_guess.hpp"

namespace isobar::test::test_units {

using namespace tools;

TEST_CASE("rates in degrees are told by their size, or by the attitude that turns 57 times less") {
  CHECK(guess_gyro_unit("", {0.1, 0.5}, 0.0, 10.0).scale == 1.0);
  CHECK(guess_gyro_unit("", {0.1, 90.0}, 0.0, 10.0).scale == doctest::Approx(kRadPerDeg));
  CHECK(guess_gyro_unit("", {0.1, 20.0}, 1.0, 1.1).scale == 1.0);
  CHECK(guess_gyro_unit("", {0.1, 20.0}, 1.0, 57.0).scale == doctest::Approx(kRadPerDeg));
  CHECK(guess_gyro_unit("rad/s", {90.0}, 0.0, 0.0).scale == 1.0);
}

TEST_CASE("a median of accelerations without gravity in any unit is not certain") {
  CHECK(guess_accel_unit("", {9.7, 9.8, 9.9}).scale == 1.0);
  CHECK(guess_accel_unit("", {1000.0, 1001.0}).scale == doctest::Approx(0.00980665));
  CHECK_FALSE(guess_accel_unit("", {0.1, 0.2}).is_certain);
  CHECK_FALSE(guess_pressure_unit("", {1.01}).is_certain);
  CHECK(guess_pressure_unit("", {1013.0}).scale == 100.0);
}

TEST_CASE("a mount of a rotation gives the rotation back, also where pitch is 90 degrees") {
  for (const Eigen::Vector3d& rpy_deg :
       {Eigen::Vector3d(10, -20, 130), Eigen::Vector3d(180, 0, 0), Eigen::Vector3d(0, 90, 20)}) {
    const Mount mount{{1, 2, 3}, rpy_deg};
    const Mount found = mount_of(mount.T_base_sensor());
    CHECK((found.T_base_sensor().matrix() - mount.T_base_sensor().matrix()).norm() < 1e-9);
  }
}

TEST_CASE("a name tells a time by its digits, from seconds to nanoseconds, and other numbers tell none") {
  CHECK(stamp_of_name("1700000000.5") == 1'700'000'000'500'000'000);
  CHECK(stamp_of_name("scan_1700000000_000000007") == 1'700'000'000'000'000'007);
  CHECK(stamp_of_name("1700000000123") == 1'700'000'000'123'000'000);
  CHECK(stamp_of_name("1700000000123456") == 1'700'000'000'123'456'000);
  CHECK(stamp_of_name("1700000000123456789") == 1'700'000'000'123'456'789);
  CHECK_FALSE(stamp_of_name("000010").has_value());
  CHECK_FALSE(stamp_of_name("0000000010").has_value());
  CHECK_FALSE(stamp_of_name("scan").has_value());
}

}  // namespace isobar::test::test_units

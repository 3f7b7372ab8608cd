// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/finding_text.hpp"

#include <doctest/doctest.h>

namespace isobar::test::test_finding_text {

TEST_CASE("a finding is a sentence with its remedy") {
  CHECK(finding_text({.kind = Contradiction::kImuMount, .measured = 180.0, .remedy = {180, 0, 0}}) ==
        "gravity points up: imu.rpy_deg = [180, 0, 0] would fit, or the accelerations have the wrong sign");
  CHECK(finding_text({.kind = Contradiction::kImuMount, .measured = 90.0, .remedy = {-90, 0, 45}}) ==
        "gravity points to the side, 90 deg from down: imu.rpy_deg = [-90, 0, 45] would fit");
  CHECK(finding_text({.kind = Contradiction::kGyroUnit, .other = CheckedSensor::kWheels, .measured = 57.2}) ==
        "the gyro turns 57 times as fast as the wheels: is it in deg/s?");
  CHECK(finding_text({.kind = Contradiction::kWheelUnit, .measured = 3.58}) ==
        "the wheels go 3.6 times as fast as the scans: are they in km/h?");
  CHECK(finding_text({.kind = Contradiction::kLidarYaw, .measured = -90.0, .remedy = {0, 0, 90}}) ==
        "the scans move 90 deg to the right of where the wheels go: lidar.rpy_deg = [0, 0, 90] would fit");
}

TEST_CASE("a difference of clocks names what makes such differences") {
  const auto text = [](double difference_s, Contradiction kind) {
    return finding_text(
        {.kind = kind, .sensor = CheckedSensor::kImu, .measured = difference_s, .evidence = 5.0});
  };
  CHECK(text(-18.0, Contradiction::kClocksApart) ==
        "the clock of the IMU is 18.0 s behind that of the lidar, as their turns show; GPS time is 18 s "
        "ahead of UTC");
  CHECK(text(-28'801.0, Contradiction::kNoOverlap) ==
        "the clock of the IMU is about 8 h 0 min 1 s behind that of the lidar: they have no time in common, "
        "5.0 s apart; "
        "is it another time zone?");
  CHECK(text(-1.7e9, Contradiction::kNoOverlap).find("counts from its own start") != std::string::npos);
  CHECK(text(3.0, Contradiction::kClocksApart) ==
        "the clock of the IMU is 3.0 s ahead of that of the lidar, as their turns show");
}

TEST_CASE("what is left out is named, and nothing where all is used") {
  CHECK(left_out_text({}).empty());
  CHECK(left_out_text({.imu = false, .wheels = false}) == "not used: IMU and wheels");
}

TEST_CASE("every finding has a sentence that fits into a health entry of 119 letters") {
  for (int kind = 0; kind <= static_cast<int>(Contradiction::kClocksApart); ++kind) {
    const std::string text = finding_text({.kind = static_cast<Contradiction>(kind),
                                           .sensor = CheckedSensor::kWheels,
                                           .other = CheckedSensor::kLidar,
                                           .measured = -18.0,
                                           .remedy = {-179.5, -12.5, -135.0}});
    CHECK_FALSE(text.empty());
    CHECK_MESSAGE(text.size() <= 119, text);
  }
}

}  // namespace isobar::test::test_finding_text

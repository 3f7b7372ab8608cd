// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/registration/map_height.hpp"
#include "tests/core/registration/height_drive.hpp"

namespace isobar::test::test_map_height_airflow {

TEST_CASE(
    "starts and stops at 3 m/s show the airflow's coefficient within its sigma, with wheels and without") {
  for (const double coefficient : {0.0, 0.017, -0.03}) {
    double normalised = 0.0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
      CAPTURE(coefficient);
      CAPTURE(seed);
      HeightDrive drive;
      drive.random.seed(seed);
      drive.speed_m_s = 0.0;
      drive.turbulence_m = 0.03;
      drive.airflow_s2_m = coefficient;
      drive.wheels = seed % 2 == 0;
      drive.stop_and_go(3.0, 240.0);
      const AltimeterState seen = drive.height.altimeter();
      const double error = seen.airflow_s2_m - coefficient;
      CHECK(std::abs(error) < 3.0 * seen.airflow_sd_s2_m);
      CHECK(seen.airflow_sd_s2_m < 0.003);
      CHECK(std::abs(drive.corrected_m) < 0.035);
      CHECK_FALSE(seen.faulty);
      normalised += error * error / (seen.airflow_sd_s2_m * seen.airflow_sd_s2_m) / 8.0;
    }
    CHECK(normalised < 2.0);
    CHECK(normalised > 0.1);
  }
}

TEST_CASE("without airflow the coefficient stays 0 within its sigma and the height moves by less than 1 cm") {
  const auto drive = [](double sigma_s2_m) {
    MapHeightConfig config;
    config.airflow_sigma_s2_m = sigma_s2_m;
    HeightDrive out;
    out.height = MapHeight(config);
    out.height.restart();
    out.speed_m_s = 0.0;
    out.turbulence_m = 0.03;
    for (int i = 0; i < 6; ++i) out.stop_and_go(i % 2 == 0 ? 1.0 : 1.5, 40.0);
    return out;
  };
  const HeightDrive with = drive(HeightDrive::kConfig.airflow_sigma_s2_m);
  const HeightDrive without = drive(0.0);
  const AltimeterState seen = with.height.altimeter();
  CHECK(std::abs(seen.airflow_s2_m) < 2.0 * seen.airflow_sd_s2_m);
  CHECK(seen.airflow_sd_s2_m < HeightDrive::kConfig.airflow_sigma_s2_m);
  CHECK(with.corrected_m != without.corrected_m);
  CHECK(std::abs(with.corrected_m - without.corrected_m) < 0.01);
}

TEST_CASE("at a constant speed nothing is learnt of the airflow, and at walking speed little") {
  HeightDrive constant;
  constant.speed_m_s = 3.0;
  constant.airflow_s2_m = 0.017;
  constant.go(240.0);
  CHECK(constant.height.altimeter().airflow_sd_s2_m > 0.01);
  HeightDrive slow;
  slow.speed_m_s = 0.0;
  slow.airflow_s2_m = 0.017;
  slow.turbulence_m = 0.03;
  slow.stop_and_go(0.5, 120.0);
  CHECK(slow.height.altimeter().airflow_sd_s2_m > 0.01);
}

TEST_CASE("the first start to 9 m/s, a metre of airflow, is no drift and moves no height") {
  HeightDrive drive;
  drive.speed_m_s = 0.0;
  drive.airflow_s2_m = 0.017;
  drive.go(20.0);
  drive.change_speed(9.0);
  for (int i = 0; i < 200; ++i) {
    REQUIRE_FALSE(drive.height.altimeter_faulty());
    drive.go(0.1);
  }
  CHECK(std::abs(drive.corrected_m) < 0.03);
  CHECK(std::abs(drive.height.altimeter().airflow_s2_m - 0.017) < 0.003);
  // What is known of the altimeter is its whole error at this speed.
  CHECK(std::abs(drive.height.bias_m() - 0.017 * 81.0) < 0.1);
}

TEST_CASE(
    "a robot that starts in motion takes the airflow's end for what it is; a restart keeps the coefficient") {
  HeightDrive drive;
  drive.speed_m_s = 4.0;
  drive.airflow_s2_m = 0.03;  // 0.48 m
  drive.go(10.0);
  drive.change_speed(0.0);
  drive.go(20.0);
  CHECK(std::abs(drive.corrected_m) < 0.03);
  const AltimeterState before = drive.height.altimeter();
  CHECK(std::abs(before.airflow_s2_m - 0.03) < 0.008);
  drive.height.restart();
  CHECK(drive.height.altimeter().airflow_s2_m == before.airflow_s2_m);
  CHECK(drive.height.altimeter().airflow_sd_s2_m == before.airflow_sd_s2_m);
  drive.height.restart_clock();
  CHECK(drive.height.altimeter().airflow_s2_m == before.airflow_s2_m);
}

TEST_CASE("the airflow's coefficient stays within the stagnation pressure's") {
  HeightDrive drive;
  drive.speed_m_s = 0.0;
  drive.airflow_s2_m = 0.2;
  drive.stop_and_go(1.0, 200.0);
  CHECK(drive.height.altimeter().airflow_s2_m > 0.03);
  CHECK(drive.height.altimeter().airflow_s2_m <= MapHeight::kLargestAirflowS2M);
}

}  // namespace isobar::test::test_map_height_airflow

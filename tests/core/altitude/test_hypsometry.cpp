// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/altitude/hypsometry.hpp"

namespace isobar::test::test_hypsometry {

TEST_CASE("heights of layers add up") {
  const double whole = hypsometric_height_m(101'325.0, 99'000.0, 288.0);
  const double parts =
      hypsometric_height_m(101'325.0, 100'200.0, 288.0) + hypsometric_height_m(100'200.0, 99'000.0, 288.0);
  CHECK(whole == doctest::Approx(parts).epsilon(1e-12));
  CHECK(hypsometric_height_m(99'000.0, 101'325.0, 288.0) == doctest::Approx(-whole).epsilon(1e-12));
}

TEST_CASE("pressure and height are inverse to each other") {
  const double p1 = hypsometric_pressure_pa(97'531.0, 12.0, 293.15);
  CHECK(hypsometric_height_m(97'531.0, p1, 293.15) == doctest::Approx(12.0).epsilon(1e-12));
}

TEST_CASE("ten kelvins are 3.4 percent of the height") {
  const double warm = hypsometric_height_m(101'325.0, 101'180.0, 303.15);
  const double cold = hypsometric_height_m(101'325.0, 101'180.0, 293.15);
  CHECK(warm / cold - 1.0 == doctest::Approx(0.0341).epsilon(0.01));
}

TEST_CASE("the standard atmosphere's table is met") {
  // U.S. Standard Atmosphere 1976: 89874.6 Pa at 1000 m (geopotential), from 101325 Pa and 288.15 K at 0 m.
  CHECK(std::abs(barometric_height_m(101'325.0, 89'874.6, 288.15) - 1'000.0) < 0.1);
}

TEST_CASE("barometric and hypsometric height agree where dz is small") {
  // Over 12 m the air cools by 0.08 K; the mean, 0.04 K, is 1.4e-4 of the height.
  const double p1 = hypsometric_pressure_pa(101'325.0, 12.0, 288.15);
  CHECK(std::abs(barometric_height_m(101'325.0, p1, 288.15) - 12.0) < 0.002);
  CHECK(barometric_height_m(101'325.0, p1, 288.15, 0.0) == doctest::Approx(12.0).epsilon(1e-12));
  CHECK(barometric_height_m(101'325.0, p1, 288.15, 1e-9) == doctest::Approx(12.0).epsilon(1e-6));
}

TEST_CASE("numerical integration equals the closed forms") {
  const auto isothermal = [](double) { return 281.0; };
  CHECK(integrated_height_m(101'325.0, 90'000.0, isothermal, 1) ==
        doctest::Approx(hypsometric_height_m(101'325.0, 90'000.0, 281.0)).epsilon(1e-12));
  const auto linear = [](double z) { return 288.15 - 0.0065 * z; };
  CHECK(integrated_height_m(101'325.0, 70'000.0, linear) ==
        doctest::Approx(barometric_height_m(101'325.0, 70'000.0, 288.15)).epsilon(1e-9));
  // Downwards too.
  CHECK(integrated_height_m(90'000.0, 101'325.0, linear) ==
        doctest::Approx(barometric_height_m(90'000.0, 101'325.0, 288.15)).epsilon(1e-9));
}

TEST_CASE("the integration converges with the fourth power of the steps") {
  const auto wavy = [](double z) { return 285.0 + 20.0 * std::sin(z / 400.0); };
  const double exact = integrated_height_m(101'325.0, 80'000.0, wavy, 4096);
  const double coarse = std::abs(integrated_height_m(101'325.0, 80'000.0, wavy, 8) - exact);
  const double fine = std::abs(integrated_height_m(101'325.0, 80'000.0, wavy, 16) - exact);
  CHECK(coarse / fine > 10.0);  // 16 in the limit
  CHECK(coarse / fine < 25.0);
}

}  // namespace isobar::test::test_hypsometry

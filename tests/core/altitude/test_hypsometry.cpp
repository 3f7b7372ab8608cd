// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/altitude/hypsometry.hpp"
#include "tests/core/altitude/isothermal_air.hpp"

namespace isobar::test::test_hypsometry {

TEST_CASE("heights of layers add up") {
  const double whole = hypsometric_height_m(101'325.0, 99'000.0, 288.0);
  const double parts =
      hypsometric_height_m(101'325.0, 100'200.0, 288.0) + hypsometric_height_m(100'200.0, 99'000.0, 288.0);
  CHECK(whole == doctest::Approx(parts).epsilon(1e-12));
  CHECK(hypsometric_height_m(99'000.0, 101'325.0, 288.0) == doctest::Approx(-whole).epsilon(1e-12));
}

TEST_CASE("pressure and height are inverse functions") {
  const double p1 = hypsometric_pressure_pa(97'531.0, 12.0, 293.15);
  CHECK(hypsometric_height_m(97'531.0, p1, 293.15) == doctest::Approx(12.0).epsilon(1e-12));
}

TEST_CASE("an air temperature 10 K too high gives a height 3.4 percent too large") {
  const double warm = hypsometric_height_m(101'325.0, 101'180.0, 303.15);
  const double cold = hypsometric_height_m(101'325.0, 101'180.0, 293.15);
  CHECK(warm / cold - 1.0 == doctest::Approx(0.0341).epsilon(0.01).scale(0.0));
}

TEST_CASE("the first kilometre agrees with the table of the standard atmosphere") {
  // U.S. Standard Atmosphere 1976: 89874.6 Pa at 1000 m (geopotential), from 101325 Pa and 288.15 K at 0 m.
  // The mean temperature of a layer with a constant lapse rate is its harmonic mean, dT / ln(T0 / T1).
  const double mean_k = 6.5 / std::log(288.15 / 281.65);
  CHECK(std::abs(hypsometric_height_m(101'325.0, 89'874.6, mean_k) - 1'000.0) < 0.1);
}

}  // namespace isobar::test::test_hypsometry

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "drivers/setra278/span.hpp"

namespace isobar::test::test_span {

using namespace isobar::setra278;

TEST_CASE("the spans of the order codes give their pressures") {
  CHECK(pressure_of({0.0, 2.5, 60e3, 110e3}, 1.25).pressure_pa == doctest::Approx(85e3));
  CHECK(pressure_of({0.0, 5.0, 50e3, 110e3}, 4.0).pressure_pa == doctest::Approx(98e3));
  CHECK(pressure_of({0.0, 5.0, 80e3, 110e3}, 4.0).pressure_pa == doctest::Approx(104e3));
  CHECK(pressure_of({0.0, 1.65, 60e3, 110e3}, 1.32).pressure_pa ==
        doctest::Approx(100e3));  // behind a divider
}

TEST_CASE("an open wire and a saturated converter are reported, at the ends of the span and beyond") {
  const Span span;
  for (const double volts : {-5.0, -0.001, 0.0, 0.001, 0.012}) {
    CHECK(std::string(pressure_of(span, volts).fault).find("below") != std::string::npos);
  }
  for (const double volts : {2.488, 2.5, 2.6, 12.0}) {
    CHECK(std::string(pressure_of(span, volts).fault).find("above") != std::string::npos);
  }
  CHECK(pressure_of(span, 0.02).fault == nullptr);
  CHECK(pressure_of(span, 2.48).fault == nullptr);
}

TEST_CASE("for any voltage the result is a pressure inside the span or a fault") {
  std::mt19937 random(9);
  std::normal_distribution<double> any(1.0, 3.0);
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const Span span;
  int good = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Reading reading = pressure_of(span, any(random));
    if (reading.fault != nullptr) continue;
    ++good;
    REQUIRE(reading.pressure_pa > span.low_pa);
    REQUIRE(reading.pressure_pa < span.high_pa);
  }
  CHECK(good > 1'000);
  for (const double volts : {kInf, -kInf, std::nan("")}) CHECK(pressure_of(span, volts).fault != nullptr);
}

TEST_CASE("a reversed or empty span is refused") {
  CHECK(broken_rule(Span{}) == nullptr);
  CHECK(broken_rule({2.5, 0.0, 60e3, 110e3}) != nullptr);
  CHECK(broken_rule({1.0, 1.0, 60e3, 110e3}) != nullptr);
  CHECK(broken_rule({0.0, 2.5, 110e3, 60e3}) != nullptr);
}

}  // namespace isobar::test::test_span

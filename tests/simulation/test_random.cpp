// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/random.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace isobar::test::test_random {

using namespace isobar::simulation;

TEST_CASE("the streams have the moments of their distributions") {
  Random random(7, "moments");
  constexpr int kDraws = 100'000;
  double sum = 0.0;
  double squares = 0.0;
  double uniform = 0.0;
  double exponential = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    uniform += random.uniform();
    exponential += random.exponential(2.0);
  }
  // Five standard deviations of a mean over 100000 draws: 5 / sqrt(100000) = 0.016 sigma.
  CHECK(std::abs(sum / kDraws) < 0.016);
  CHECK(std::abs(squares / kDraws - 1.0) < 0.023);
  CHECK(std::abs(uniform / kDraws - 0.5) < 0.005);
  CHECK(std::abs(exponential / kDraws - 2.0) < 0.032);
}

TEST_CASE("streams with another name, index or seed differ; streams with the same are equal") {
  CHECK(Random(1, "a").next() == Random(1, "a").next());
  CHECK(Random(1, "a").next() != Random(1, "b").next());
  CHECK(Random(1, "a", 0).next() != Random(1, "a", 1).next());
  CHECK(Random(1, "a").next() != Random(2, "a").next());
}

TEST_CASE(
    "correlated noise has its standard deviation at every step and its correlation after a time constant") {
  GaussMarkov process(2.0, 5.0, Random(3));
  constexpr int kSteps = 400'000;
  double previous = process.step(0.0);
  double squares = 0.0;
  double products = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double value = process.step(0.5);
    squares += value * value;
    products += value * previous;
    previous = value;
  }
  // 400000 steps of a tenth of a time constant equal 20000 independent ones: 5 sigma of the variance is 5 %.
  CHECK(squares / kSteps == doctest::Approx(4.0).epsilon(0.05));
  CHECK(products / squares == doctest::Approx(std::exp(-0.1)).epsilon(0.01));
}

}  // namespace isobar::test::test_random

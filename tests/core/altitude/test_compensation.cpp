// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/altitude/compensation.hpp"

namespace isobar::test::test_compensation {

namespace {

/// Eq. (1) written out, in long double: the independent computation.
double by_definition(const Eigen::Matrix4d& A, double p, double t) {
  long double sum = 0.0L;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      sum += static_cast<long double>(A(i, j)) * std::pow(static_cast<long double>(p), i) *
             std::pow(static_cast<long double>(t), j);
    }
  }
  return static_cast<double>(sum);
}

Eigen::Matrix4d realistic_coefficients() {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A(0, 0) = 35.0;
  A(1, 0) = 0.9991;
  A(2, 0) = 3e-9;
  A(3, 0) = -2e-14;
  A(0, 1) = -1.9;
  A(1, 1) = 2e-6;
  A(2, 1) = 1e-12;
  A(0, 2) = 0.02;
  A(0, 3) = -1e-4;
  return A;
}

constexpr Compensation::Variables kVariables{98'000.0, 4'000.0, 25.0, 15.0};

}  // namespace

TEST_CASE("a compensation does nothing until it is given coefficients") {
  CHECK(Compensation()(98'765.4, 21.0) == doctest::Approx(98'765.4).epsilon(1e-15));
}

TEST_CASE("centred evaluation equals eq. (1) in plain powers") {
  const Eigen::Matrix4d A = realistic_coefficients();
  const auto compensation = Compensation::from_raw_powers(A, kVariables);
  for (double p = 90'000.0; p <= 106'000.0; p += 1'777.0) {
    for (double t = -10.0; t <= 60.0; t += 7.0) {
      // 1e-6 Pa: a millionth of what a barometer resolves, and above the rounding of sums of 1e5.
      CHECK(std::abs(compensation(p, t) - by_definition(A, p, t)) < 1e-6);
    }
  }
}

TEST_CASE("the plain coefficients come back from the centred ones") {
  const Eigen::Matrix4d A = realistic_coefficients();
  const Eigen::Matrix4d back = Compensation::from_raw_powers(A, kVariables).raw_powers();
  for (int i = 0; i < 4; ++i) {
    // In units of their effect at 100 kPa, to 1e-4 Pa: plain powers cannot carry more (the reason for
    // centring).
    for (int j = 0; j < 4; ++j) CHECK(std::abs(back(i, j) - A(i, j)) * std::pow(1e5, i) < 1e-4);
  }
}

TEST_CASE("coefficients outside the mask take no part") {
  const Eigen::Matrix4d A = realistic_coefficients();
  const auto simple = Compensation::from_raw_powers(A, kVariables, kMaskSimple);
  Eigen::Matrix4d kept = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 4; ++i) kept(i, 0) = A(i, 0);
  kept(0, 1) = A(0, 1);
  CHECK(simple(101'000.0, 33.0) == doctest::Approx(by_definition(kept, 101'000.0, 33.0)).epsilon(1e-12));
  CHECK(std::abs(simple(101'000.0, 33.0) - by_definition(A, 101'000.0, 33.0)) > 1.0);
}

TEST_CASE("the paper's masks hold as many coefficients as its table") {
  const auto count = [](CompensationMask mask) { return __builtin_popcount(mask); };
  CHECK(count(kMaskP) == 4);
  CHECK(count(kMaskSimple) == 5);
  CHECK(count(kMaskInd) == 7);
  CHECK(count(kMaskM) == 7);
  CHECK(count(kMaskFull) == 16);
}

}  // namespace isobar::test::test_compensation

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "core/altitude/compensation_model.hpp"

namespace isobar::test::test_compensation {

namespace {

constexpr Compensation::Variables kVariables{98'000.0, 4'000.0, 25.0, 15.0};

/// Eq. (1) in u and v, term by term in long double: the independent computation.
double by_definition(const Eigen::Matrix4d& A, double p, double t) {
  const long double u = (static_cast<long double>(p) - 98'000.0L) / 4'000.0L;
  const long double v = (static_cast<long double>(t) - 25.0L) / 15.0L;
  long double sum = 0.0L;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      sum += static_cast<long double>(A(i, j)) * std::pow(u, i) * std::pow(v, j);
    }
  }
  return static_cast<double>(sum);
}

}  // namespace

TEST_CASE("a compensation without coefficients is the identity") {
  CHECK(Compensation()(98'765.4, 21.0) == doctest::Approx(98'765.4).epsilon(1e-15));
}

TEST_CASE("nested evaluation equals eq. (1) term by term") {
  Eigen::Matrix4d A;
  A << 97'950.0, -38.0, 4.0, -0.3,  //
      3'998.0, 0.5, 0.1, 0.02,      //
      6.0, -0.2, 0.03, -0.01,       //
      -1.5, 0.08, -0.02, 0.004;
  const Compensation compensation(A, kVariables);
  for (double p = 90'000.0; p <= 106'000.0; p += 1'777.0) {
    for (double t = -10.0; t <= 60.0; t += 7.0) {
      // 1e-6 Pa: a millionth of a barometer's resolution, and above the rounding of sums of 1e5.
      CHECK(std::abs(compensation(p, t) - by_definition(A, p, t)) < 1e-6);
    }
  }
}

TEST_CASE("the models have as many coefficients as the paper's table says") {
  const auto count = [](CompensationModel model) { return std::popcount(free_coefficients(model)); };
  CHECK(count(CompensationModel::kNone) == 0);
  CHECK(count(CompensationModel::kOffset) == 1);
  CHECK(count(CompensationModel::kP) == 4);
  CHECK(count(CompensationModel::kSimple) == 5);
  CHECK(count(CompensationModel::kInd) == 7);
  CHECK(count(CompensationModel::kM) == 7);
  CHECK(count(CompensationModel::kFull) == 16);
}

TEST_CASE("every name of a model is found again, and no other word") {
  for (const auto& [model, name] : kCompensationModelNames.entries) {
    CHECK(kCompensationModelNames.name(model) == name);
    CHECK(kCompensationModelNames.value(name) == model);
  }
  CHECK_FALSE(kCompensationModelNames.value("a_p").has_value());
  CHECK_FALSE(kCompensationModelNames.value("").has_value());
  CHECK(kCompensationModelNames.name(static_cast<CompensationModel>(99)) == "unknown");
}

}  // namespace isobar::test::test_compensation

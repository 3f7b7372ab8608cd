// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/registration/method.hpp"

namespace isobar::test::test_method {

using isobar::HeightSource;
using isobar::Method;
using isobar::traits_of;
using isobar::ZPrediction;

TEST_CASE("each method has as many free directions as its name says") {
  const auto columns = [](Method method) {
    return traits_of(method, HeightSource::kDifferential).basis.cols();
  };
  CHECK(columns(Method::k6Dof) == 6);
  CHECK(columns(Method::k6DofAltitude) == 6);
  CHECK(columns(Method::k4Dof) == 4);
  CHECK(columns(Method::k4DofAltitude) == 4);
  CHECK(columns(Method::k3Dof) == 3);
}

TEST_CASE("only methods with altitude in the name or with fixed z use the altimeter") {
  const auto z = [](Method method) { return traits_of(method, HeightSource::kDifferential).z_prediction; };
  CHECK(z(Method::k3Dof) == ZPrediction::kAltimeter);
  CHECK(z(Method::k4DofAltitude) == ZPrediction::kAltimeter);
  CHECK(z(Method::k6DofAltitude) == ZPrediction::kAltimeter);
  CHECK(z(Method::k4Dof) == ZPrediction::kDeadReckoning);
  CHECK(z(Method::k6Dof) == ZPrediction::kDeadReckoning);
  CHECK(z(Method::kOdometry) == ZPrediction::kDeadReckoning);
}

TEST_CASE("without any height a method falls back to the one that needs none") {
  const auto effective = [](Method method) { return traits_of(method, HeightSource::kNone).method; };
  CHECK(effective(Method::k3Dof) == Method::k4Dof);
  CHECK(effective(Method::k4DofAltitude) == Method::k4Dof);
  CHECK(effective(Method::k6DofAltitude) == Method::k6Dof);
  CHECK(effective(Method::k6Dof) == Method::k6Dof);
  CHECK(effective(Method::kOdometry) == Method::kOdometry);
}

}  // namespace isobar::test::test_method

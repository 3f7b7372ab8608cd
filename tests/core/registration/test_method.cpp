// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/registration/method.hpp"

namespace isobar::test::test_method {

using isobar::Constraint;
using isobar::HeightSource;
using isobar::Method;
using isobar::traits_of;

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

TEST_CASE("only methods with altitude in the name, with fixed z, and the adaptive one use the altimeter") {
  const auto z = [](Method method) { return traits_of(method, HeightSource::kDifferential).height; };
  CHECK(z(Method::k3Dof) == Constraint::kFixed);
  CHECK(z(Method::k4DofAltitude) == Constraint::kSoft);
  CHECK(z(Method::k6DofAltitude) == Constraint::kSoft);
  CHECK(z(Method::kAdaptive) == Constraint::kSoft);
  CHECK(z(Method::k4Dof) == Constraint::kFree);
  CHECK(z(Method::k6Dof) == Constraint::kFree);
  CHECK(z(Method::kOdometry) == Constraint::kFree);
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

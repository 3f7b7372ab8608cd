// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/method.hpp"

#include <initializer_list>

namespace isobar {

namespace {

Basis columns_of_identity(std::initializer_list<int> columns) {
  Basis basis = Basis::Zero(6, static_cast<Eigen::Index>(columns.size()));
  Eigen::Index column = 0;
  for (const int row : columns) {
    basis(row, column++) = 1.0;
  }
  return basis;
}

Method without_height(Method method) {
  switch (method) {
    case Method::k3Dof:
    case Method::k4DofAltitude:
      return Method::k4Dof;
    case Method::k6DofAltitude:
      return Method::k6Dof;
    default:
      return method;
  }
}

}  // namespace

MethodTraits traits_of(Method method, HeightSource height) {
  if (height == HeightSource::kNone) {
    method = without_height(method);
  }
  switch (method) {
    case Method::k6Dof:
      return {method, true, false, ZPrediction::kDeadReckoning, columns_of_identity({0, 1, 2, 3, 4, 5})};
    case Method::k6DofAltitude:
      return {method, true, false, ZPrediction::kAltimeter, columns_of_identity({0, 1, 2, 3, 4, 5})};
    case Method::k4Dof:
      return {method, true, true, ZPrediction::kDeadReckoning, columns_of_identity({2, 3, 4, 5})};
    case Method::k4DofAltitude:
      return {method, true, true, ZPrediction::kAltimeter, columns_of_identity({2, 3, 4, 5})};
    case Method::kOdometry:
      return {method, false, true, ZPrediction::kDeadReckoning, columns_of_identity({2, 3, 4})};
    case Method::k3Dof:
      break;
  }
  // tau = (gamma, r_x, r_y), before equation (8) of the paper.
  return {Method::k3Dof, true, true, ZPrediction::kAltimeter, columns_of_identity({2, 3, 4})};
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/method.hpp"

#include <algorithm>
#include <array>

namespace isobar {

namespace {

struct Row {
  Method method;
  Constraint tilt;
  Constraint height;
  Constraint level;
  Method without_height;
};

using enum Constraint;

// 3-DOF: tau = (gamma, r_x, r_y), before equation (8) of the paper.
constexpr std::array kRows{
    //  method                 tilt    height  level   without a height
    Row{Method::kAdaptive, kSoft, kSoft, kFree, Method::kAdaptive},
    Row{Method::k3Dof, kFixed, kFixed, kFree, Method::k4Dof},
    Row{Method::k4Dof, kFixed, kFree, kFree, Method::k4Dof},
    Row{Method::k4DofAltitude, kFixed, kSoft, kFree, Method::k4Dof},
    Row{Method::k6Dof, kFree, kFree, kFree, Method::k6Dof},
    Row{Method::k6DofAltitude, kFree, kSoft, kFree, Method::k6Dof},
    Row{Method::kOdometry, kFixed, kFree, kFixed, Method::kOdometry},
};

const Row& row_of(Method method) {
  return *std::find_if(kRows.begin(), kRows.end(), [&](const Row& row) { return row.method == method; });
}

Basis basis_of(const Row& row) {
  const std::array<Constraint, 6> directions{row.tilt, row.tilt, row.level, row.level, row.level, row.height};
  Basis basis = Basis::Zero(6, std::count_if(directions.begin(), directions.end(),
                                             [](Constraint constraint) { return constraint != kFixed; }));
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (directions[i] != kFixed) basis(static_cast<Eigen::Index>(i), column++) = 1.0;
  }
  return basis;
}

}  // namespace

MethodTraits traits_of(Method method, HeightSource height) {
  const Row* row = &row_of(method);
  if (height == HeightSource::kNone) row = &row_of(row->without_height);
  MethodTraits traits{row->method, row->tilt, row->height, row->level, basis_of(*row)};
  if (height == HeightSource::kNone) traits.height = kFree;
  return traits;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Table of methods: the free directions of the solver, and the prediction of z.
#pragma once

#include <Eigen/Core>

#include "core/estimates.hpp"
#include "core/registration/twist.hpp"

namespace isobar {

/// Free directions of the solver: columns in the space of twists (twist.hpp). 1 … 6 columns, orthonormal.
using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// Source of the predicted z.
enum class ZPrediction : std::uint8_t {
  kDeadReckoning,  ///< increments of dead reckoning
  kAltimeter,      ///< absolute height from air pressure
};

/// One row of the table of methods.
struct MethodTraits {
  Method method = Method::k3Dof;
  bool registers = true;              ///< false: dead reckoning alone
  bool attitude_from_gravity = true;  ///< roll and pitch are the prior's, not estimated
  ZPrediction z_prediction = ZPrediction::kAltimeter;
  Basis basis;  ///< directions that the ICP estimates; the others stay at the prediction
};

/// The row of `method`. Where `height` is kNone, methods that need a height fall back: 3-DOF and 4-DOF with
/// altitude to 4-DOF, 6-DOF with altitude to 6-DOF.
MethodTraits traits_of(Method method, HeightSource height);

}  // namespace isobar

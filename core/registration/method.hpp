// SPDX-License-Identifier: BSD-3-Clause
// What distinguishes the methods: which directions the solver may move in, and what predicts z.
#pragma once

#include <Eigen/Core>

#include "core/estimates.hpp"

namespace isobar {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Free directions of the solver: columns in the space of twists (omega_x, omega_y, omega_z, r_x, r_y, r_z),
/// axes of the map, about the robot's position. 1 … 6 columns, orthonormal.
using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// Where the prediction of z comes from.
enum class ZPrediction : std::uint8_t {
  kDeadReckoning,  ///< increments of dead reckoning
  kAltimeter,      ///< absolute height from air pressure
};

/// One row of the table of methods.
struct MethodTraits {
  Method method = Method::k3Dof;
  bool registers = true;              ///< false: dead reckoning alone
  bool attitude_from_gravity = true;  ///< roll and pitch are not estimated
  ZPrediction z_prediction = ZPrediction::kAltimeter;
  Basis basis;  ///< what the ICP may change; its complement stays at the prediction
};

/// The row of `method`; one that needs a height falls back to the one without where `height` is kNone.
MethodTraits traits_of(Method method, HeightSource height);

}  // namespace isobar

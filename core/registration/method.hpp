// SPDX-License-Identifier: BSD-3-Clause
// Table of methods: what holds each group of directions of the solver.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/estimates.hpp"
#include "core/registration/twist.hpp"

namespace isobar {

/// Free directions of the solver: columns in the space of twists (twist.hpp). 1 … 6 columns, orthonormal.
using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// What another source than the scan says of a group of directions: gravity of roll and pitch, the altimeter of z,
/// dead reckoning of x, y and yaw.
enum class Constraint : std::uint8_t {
  kFree,   ///< only how the group has changed since the last scan
  kSoft,   ///< where it is, as information in the prior of the ICP
  kFixed,  ///< where it is; the ICP does not move it
};

/// One row of the table of methods.
struct MethodTraits {
  Method method = Method::kAdaptive;
  Constraint tilt = Constraint::kFixed;    ///< roll and pitch
  Constraint height = Constraint::kFixed;  ///< z
  Constraint level = Constraint::kFree;    ///< x, y and yaw; kFixed: dead reckoning alone, no ICP
  Basis basis;                             ///< directions that are not fixed

  /// z starts from the altimeter's height: the paper's methods with altitude. The adaptive one corrects its own slowly.
  [[nodiscard]] bool follows_altimeter() const {
    return height != Constraint::kFree && method != Method::kAdaptive;
  }
  [[nodiscard]] bool registers() const { return level != Constraint::kFixed; }
};

/// The row of `method`. Where `height` is kNone the height is free: 3-DOF and 4-DOF with altitude run as 4-DOF,
/// 6-DOF with altitude as 6-DOF.
MethodTraits traits_of(Method method, HeightSource height);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/compensation.hpp"

namespace isobar {
namespace {

/// Row k: coefficients of the powers of x in (scale x + shift)^k, by the binomial theorem.
Eigen::Matrix4d powers_of_affine(double scale, double shift) {
  Eigen::Matrix4d rows = Eigen::Matrix4d::Zero();
  rows(0, 0) = 1.0;
  for (int k = 1; k < 4; ++k) {
    for (int j = 0; j <= k; ++j) {
      rows(k, j) = shift * rows(k - 1, j) + (j > 0 ? scale * rows(k - 1, j - 1) : 0.0);
    }
  }
  return rows;
}

Eigen::Matrix4d masked(Eigen::Matrix4d coefficients, CompensationMask mask) {
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if ((mask & coefficient(i, j)) == 0) coefficients(i, j) = 0.0;
    }
  }
  return coefficients;
}

}  // namespace

Compensation::Compensation() : Compensation(Eigen::Matrix4d::Zero(), Variables{}) { centred_(1, 0) = 1.0; }

Compensation::Compensation(const Eigen::Matrix4d& centred, const Variables& variables, CompensationMask mask)
    : centred_(masked(centred, mask)), variables_(variables) {}

Compensation Compensation::from_raw_powers(const Eigen::Matrix4d& coefficients, const Variables& variables,
                                           CompensationMask mask) {
  // p = scale u + centre, so powers of p are rows of B times powers of u, and p A t = u (B_p^T A B_t) v.
  const Eigen::Matrix4d to_u = powers_of_affine(variables.pressure_scale, variables.pressure_centre);
  const Eigen::Matrix4d to_v =
      powers_of_affine(variables.temperature_scale_c, variables.temperature_centre_c);
  return {to_u.transpose() * masked(coefficients, mask) * to_v, variables};
}

Eigen::Matrix4d Compensation::raw_powers() const {
  const Variables& vs = variables_;
  const Eigen::Matrix4d to_p =
      powers_of_affine(1.0 / vs.pressure_scale, -vs.pressure_centre / vs.pressure_scale);
  const Eigen::Matrix4d to_t =
      powers_of_affine(1.0 / vs.temperature_scale_c, -vs.temperature_centre_c / vs.temperature_scale_c);
  return to_p.transpose() * centred_ * to_t;
}

double Compensation::operator()(double pressure_raw, double temperature_c) const {
  const double u = (pressure_raw - variables_.pressure_centre) / variables_.pressure_scale;
  const double v = (temperature_c - variables_.temperature_centre_c) / variables_.temperature_scale_c;
  // Horner in v within Horner in u.
  double result = 0.0;
  for (int i = 3; i >= 0; --i) {
    const double row = centred_(i, 0) + v * (centred_(i, 1) + v * (centred_(i, 2) + v * centred_(i, 3)));
    result = result * u + row;
  }
  return result;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/compensation.hpp"

namespace isobar {

Compensation::Compensation() : Compensation(Eigen::Matrix4d::Zero(), Variables{}) { centred_(1, 0) = 1.0; }

Compensation::Compensation(const Eigen::Matrix4d& centred, const Variables& variables)
    : centred_(centred), variables_(variables) {}

double Compensation::operator()(double pressure_pa, double temperature_c) const {
  const double u = (pressure_pa - variables_.pressure_centre_pa) / variables_.pressure_scale_pa;
  const double v = (temperature_c - variables_.temperature_centre_c) / variables_.temperature_scale_c;
  // Horner's scheme in v, nested in Horner's scheme in u.
  double result = 0.0;
  for (int i = 3; i >= 0; --i) {
    const double row = centred_(i, 0) + v * (centred_(i, 1) + v * (centred_(i, 2) + v * centred_(i, 3)));
    result = result * u + row;
  }
  return result;
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Pressure compensation: bicubic polynomial in raw pressure and temperature, eq. (1) of the paper.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// Set of coefficients c_ij (i: power of pressure, j: power of temperature); c_ij is bit 4 i + j.
using CompensationMask = std::uint16_t;

constexpr CompensationMask coefficient(int i, int j) {
  return static_cast<CompensationMask>(1U << (4 * i + j));
}

/// The paper's models.
inline constexpr CompensationMask kMaskP =
    coefficient(0, 0) | coefficient(1, 0) | coefficient(2, 0) | coefficient(3, 0);
inline constexpr CompensationMask kMaskSimple = kMaskP | coefficient(0, 1);
inline constexpr CompensationMask kMaskInd =
    kMaskP | coefficient(0, 1) | coefficient(0, 2) | coefficient(0, 3);
inline constexpr CompensationMask kMaskM = kMaskP | coefficient(0, 1) | coefficient(1, 1) | coefficient(2, 1);
inline constexpr CompensationMask kMaskFull = 0xFFFF;

/// p_cal = p A t with p = [1 p_raw p_raw^2 p_raw^3], t = [1 t t^2 t^3]^T, t in degrees Celsius. Stored and
/// evaluated in the centred, scaled variables u = (p_raw - p_centre) / p_scale, v = (t - t_centre) / t_scale:
/// in plain powers of 100 kPa the columns span 15 decades, so a fit loses all its digits and an evaluation
/// cancels terms a thousand times its result.
class Compensation {
 public:
  /// Centre and scale of u and v; scales must not be zero.
  struct Variables {
    double pressure_centre_pa = 0.0;
    double pressure_scale_pa = 1.0;
    double temperature_centre_c = 0.0;
    double temperature_scale_c = 1.0;
  };

  /// Identity: the compensated pressure is the raw pressure.
  Compensation();

  /// `centred`: 4x4, element (i, j) is the coefficient of u^i v^j [Pa].
  Compensation(const Eigen::Matrix4d& centred, const Variables& variables);

  /// Compensated pressure [Pa] of a raw pressure [Pa] and temperature [degC].
  [[nodiscard]] double operator()(double pressure_pa, double temperature_c) const;

  [[nodiscard]] const Eigen::Matrix4d& centred() const { return centred_; }
  [[nodiscard]] const Variables& variables() const { return variables_; }

 private:
  Eigen::Matrix4d centred_;
  Variables variables_;
};

}  // namespace isobar

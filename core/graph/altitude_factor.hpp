// SPDX-License-Identifier: BSD-3-Clause
// Altitude as a factor of the pose graph, and the altimeter's bias as a state that varies slowly.
//
//     e = (z + b - h) / sigma,                    de/dz = de/db = 1 / sigma
//     e = (b' - phi b) / s,  phi = exp(-dt / T),  s^2 = bias_sigma^2 (1 - phi^2) + walk^2 dt,
//                                                 de/db' = 1 / s,  de/db = -phi / s
//
// h: height by the altimeter, b: its bias. The second error chains the biases of the nodes in the order of their stamps: a
// first-order Gauss-Markov process (Gelb, "Applied optimal estimation", 1974, section 3.8), as in
// registration/map_height.hpp. Over a time much longer than T, as between two sessions, the chain lets go by itself.
#pragma once

#include <cmath>

#include "core/graph/graph_node.hpp"
#include "core/squared.hpp"

namespace isobar {

/// Height of a submap's origin by the altimeter.
struct AltitudeFactor {
  NodeId node = 0;
  double height_m = 0.0;  ///< z in the map, bias included
  double sigma_m = 0.1;   ///< white noise of this reading, 1 sigma
};

/// Bias of the altimeter over time.
struct AltimeterBias {
  double sigma_m = 0.15;  ///< ventilated zones, warm-up, weather that the base station does not share [m] …
  double time_s = 450.0;  ///< … and its correlation time [s]
  double start_sigma_m = 0.02;  ///< at the first altitude, where it is zero by definition [m]
  /// Without a base station: random walk with the weather [m/sqrt(s)]. Above 0 the bias does not return to zero.
  double weather_walk_m_sqrt_s = 0.0;
};

/// Change of the bias over a time: b' = phi b + noise of sigma_m.
struct BiasLink {
  double phi = 1.0;
  double sigma_m = 1.0;
};

/// Least standard deviation of a change of the bias [m]: two submaps of one time.
inline constexpr double kLeastBiasChangeM = 1e-4;

/// Change of the bias over `dt_s` >= 0.
inline BiasLink bias_link(const AltimeterBias& bias, double dt_s) {
  const double phi = std::exp(-dt_s / bias.time_s);
  const bool walks = bias.weather_walk_m_sqrt_s > 0.0;
  const double variance_m2 =
      squared(bias.sigma_m) * (1.0 - phi * phi) + squared(bias.weather_walk_m_sqrt_s) * dt_s;
  return {walks ? 1.0 : phi, std::sqrt(variance_m2 + squared(kLeastBiasChangeM))};
}

/// Error of an altitude over its sigma.
inline double altitude_error(const AltitudeFactor& factor, double z_m, double bias_m) {
  return (z_m + bias_m - factor.height_m) / factor.sigma_m;
}

/// Jacobian of altitude_error() by the node's step.
inline NodeJacobian<1> altitude_jacobian(const AltitudeFactor& factor) {
  NodeJacobian<1> J = NodeJacobian<1>::Zero();
  J(2) = J(kBiasColumn) = 1.0 / factor.sigma_m;
  return J;
}

/// Error of a change of the bias over its sigma.
inline double bias_error(const BiasLink& link, double earlier_m, double later_m) {
  return (later_m - link.phi * earlier_m) / link.sigma_m;
}

/// Jacobian of an error by the node's bias alone.
inline NodeJacobian<1> bias_jacobian(double by_bias) {
  NodeJacobian<1> J = NodeJacobian<1>::Zero();
  J(kBiasColumn) = by_bias;
  return J;
}

}  // namespace isobar

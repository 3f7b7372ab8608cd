// SPDX-License-Identifier: BSD-3-Clause
// Pairs of simple surfaces whose normals err, for the localisability of directions.
#pragma once

#include <random>
#include <vector>

#include "core/registration/correspondences.hpp"

namespace isobar::test {

/// `pair` with a normal turned by an error of `noise_rad`, 1 sigma about each axis across it.
Pair with_noise(const Pair& pair, double noise_rad, std::mt19937& random);

/// A floor of 20 m, 1 m below the robot.
std::vector<Pair> noisy_plane(double noise_rad);
/// A square tunnel of 3 m without any feature along it.
std::vector<Pair> noisy_tunnel(double noise_rad, const Eigen::Vector3f& along);
/// A round, vertical shaft of 2 m radius.
std::vector<Pair> noisy_shaft(double noise_rad);
/// The inside of a cube of 8 m.
std::vector<Pair> noisy_cube(double noise_rad);

}  // namespace isobar::test

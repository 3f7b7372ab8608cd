// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/registration/noisy_surfaces.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace isobar::test {

namespace {

constexpr int kPairs = 1800;

/// kPairs pairs that `make` draws.
template <typename Make>
std::vector<Pair> drawn(double noise_rad, Make&& make) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  std::vector<Pair> pairs;
  for (int i = 0; i < kPairs; ++i) pairs.push_back(with_noise(make(i, unit, random), noise_rad, random));
  return pairs;
}

}  // namespace

Pair with_noise(const Pair& pair, double noise_rad, std::mt19937& random) {
  std::normal_distribution<double> error(0.0, 1.0);
  const Eigen::Vector3d n = pair.normal.cast<double>();
  const Eigen::Vector3d across = n.unitOrthogonal();
  const Eigen::Vector3d moved = n + noise_rad * (error(random) * across + error(random) * n.cross(across));
  Pair noisy = pair;
  noisy.normal = moved.normalized().cast<float>();
  return noisy;
}

std::vector<Pair> noisy_plane(double noise_rad) {
  return drawn(noise_rad, [](int, auto& unit, auto& random) {
    return Pair{{10.0F * unit(random), 10.0F * unit(random), -1.0F}, Eigen::Vector3f::UnitZ(), 0.0F};
  });
}

std::vector<Pair> noisy_tunnel(double noise_rad, const Eigen::Vector3f& along) {
  const Eigen::Vector3f side = Eigen::Vector3f::UnitZ().cross(along);
  return drawn(noise_rad, [&](int i, auto& unit, auto& random) {
    const float sign = i % 4 < 2 ? 1.0F : -1.0F;
    const Eigen::Vector3f normal =
        i % 2 == 0 ? Eigen::Vector3f(sign * side) : Eigen::Vector3f(sign * Eigen::Vector3f::UnitZ());
    const Eigen::Vector3f across = normal.cross(along);
    return Pair{10.0F * unit(random) * along + 1.5F * unit(random) * across - 1.5F * normal, normal, 0.0F};
  });
}

std::vector<Pair> noisy_shaft(double noise_rad) {
  return drawn(noise_rad, [](int, auto& unit, auto& random) {
    const float angle = 3.14159265F * unit(random);
    const Eigen::Vector3f out(std::cos(angle), std::sin(angle), 0.0F);
    return Pair{2.0F * out + Eigen::Vector3f(0.0F, 0.0F, 8.0F * unit(random)), -out, 0.0F};
  });
}

std::vector<Pair> noisy_cube(double noise_rad) {
  return drawn(noise_rad, [](int i, auto& unit, auto& random) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    normal(i % 3) = i % 2 == 0 ? 1.0F : -1.0F;
    Eigen::Vector3f p(4.0F * unit(random), 4.0F * unit(random), 4.0F * unit(random));
    p(i % 3) = -4.0F * normal(i % 3);
    return Pair{p, normal, 0.0F};
  });
}

}  // namespace isobar::test

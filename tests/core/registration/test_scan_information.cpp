// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "core/geometry.hpp"
#include "core/registration/point_to_plane.hpp"
#include "core/registration/scan_information.hpp"
#include "tests/core/registration/noisy_surfaces.hpp"

namespace isobar::test::test_scan_information {

using namespace isobar;  // NOLINT(google-build-using-namespace)

namespace {

ScanInformation information_of(const std::vector<Pair>& pairs, double known_noise_rad = kRadPerDeg) {
  SolverWeights weights;
  weights.normal_variance = known_noise_rad * known_noise_rad;
  weights.point_variance_m2 = 0.01 * 0.01;
  weights.correlated_pairs = 10.0;
  return scan_information(accumulate(pairs, PairNoise{}, 10.0F), Basis::Identity(6, 6), weights);
}

std::size_t weak_count(const ScanInformation& information) {
  std::size_t weak = 0;
  for (const StepDirection& direction : information.directions) weak += direction.strength < 0.5 ? 1 : 0;
  return weak;
}

}  // namespace

TEST_CASE("a plane alone holds its distance and two tilts; the way along it and the turn on it are weak") {
  const ScanInformation plane = information_of(noisy_plane(kRadPerDeg));
  CHECK(weak_count(plane) == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(plane.directions[i].strength < 0.1);
    // x, y and yaw: neither z nor roll nor pitch.
    CHECK(plane.directions[i].axis.head<2>().norm() < 0.1);
    CHECK(std::abs(plane.directions[i].axis(5)) < 0.1);
  }
  CHECK(plane.directions[3].strength > 0.99);
}

TEST_CASE("a tunnel is weak along its axis, and only there") {
  const ScanInformation tunnel = information_of(noisy_tunnel(kRadPerDeg, Eigen::Vector3f::UnitX()));
  CHECK(weak_count(tunnel) == 1);
  CHECK(std::abs(tunnel.directions[0].axis(3)) > 0.99);
  // The same tunnel under another heading.
  const Eigen::Vector3f along = Eigen::Vector3f(1.0F, 1.0F, 0.0F).normalized();
  const ScanInformation turned = information_of(noisy_tunnel(kRadPerDeg, along));
  CHECK(weak_count(turned) == 1);
  CHECK(std::abs(turned.directions[0].axis.tail<3>().dot(along.cast<double>())) > 0.99);
}

TEST_CASE("a round shaft is weak along its axis and about it") {
  const ScanInformation shaft = information_of(noisy_shaft(kRadPerDeg));
  CHECK(weak_count(shaft) == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(std::hypot(shaft.directions[i].axis(2), shaft.directions[i].axis(5)) > 0.99);
  }
}

TEST_CASE("an open cube holds everything") {
  const ScanInformation cube = information_of(noisy_cube(kRadPerDeg));
  CHECK(weak_count(cube) == 0);
  CHECK(cube.directions[0].strength > 0.99);
}

TEST_CASE("noise of the normals pretends strength, and is seen through") {
  // 6 deg put more information per pair along the tunnel than one face in a hundred would.
  const double noise_rad = 6.0 * kRadPerDeg;
  const auto pairs = noisy_tunnel(noise_rad, Eigen::Vector3f::UnitX());
  const NormalEquations equations = accumulate(pairs, PairNoise{}, 10.0F);
  CHECK(equations.hessian(3, 3) / equations.weight_sum > 0.01);
  CHECK(weak_count(information_of(pairs, noise_rad)) == 1);
  CHECK(information_of(pairs, noise_rad).hessian(3, 3) < 0.05 * equations.hessian(3, 3));
  // A few faces across the axis are real, and hold it.
  auto with_faces = noisy_tunnel(kRadPerDeg, Eigen::Vector3f::UnitX());
  for (std::size_t i = 0; i < with_faces.size(); i += 50) with_faces[i].normal = Eigen::Vector3f::UnitX();
  CHECK(weak_count(information_of(with_faces)) == 0);
}

TEST_CASE("the expected information of noise is that of a million noisy normals") {
  const auto exact = noisy_cube(0.0);
  const double sigma = 2.0 * kRadPerDeg;
  SolverWeights weights;
  weights.normal_variance = sigma * sigma;
  const NormalEquations equations = accumulate(exact, PairNoise{}, 10.0F);
  const Matrix6d expected = noise_information(equations, weights);
  Matrix6d sum = Matrix6d::Zero();
  std::mt19937 random(3);
  constexpr int kDraws = 300;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (const Pair& pair : exact) {
      const Pair noisy = with_noise(pair, sigma, random);
      Vector6d error;
      const Eigen::Vector3d dn = (noisy.normal - pair.normal).cast<double>();
      error << pair.p_robot.cast<double>().cross(dn), dn;
      sum += error * error.transpose() / kDraws;
    }
  }
  CHECK((sum - expected).norm() < 0.02 * expected.norm());
}

TEST_CASE("what is weak is left to the prior, what is strong keeps its information") {
  const auto pairs = noisy_tunnel(kRadPerDeg, Eigen::Vector3f::UnitX());
  const NormalEquations equations = accumulate(pairs, PairNoise{}, 10.0F);
  const ScanInformation tunnel = information_of(pairs);
  CHECK(tunnel.hessian(3, 3) < 0.05 * equations.hessian(3, 3));
  CHECK(tunnel.hessian(4, 4) > 0.99 * equations.hessian(4, 4));
  CHECK(tunnel.hessian(2, 2) > 0.99 * equations.hessian(2, 2));
}

}  // namespace isobar::test::test_scan_information

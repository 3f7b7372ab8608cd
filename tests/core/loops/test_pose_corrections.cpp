// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/loops/pose_corrections.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_pose_corrections {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

Eigen::Isometry3d pose(double x_m, double yaw_rad = 0.0) {
  return Eigen::Translation3d(x_m, 0.0, 0.0) * rotation_from_rpy({0.0, 0.0, yaw_rad});
}

TEST_CASE("without key scans poses stay as they are") {
  const PoseCorrections none({});
  CHECK(none.corrected(kSecond, pose(3.0)).matrix() == pose(3.0).matrix());
}

TEST_CASE("a pose at a key scan is the corrected one, in any order of the keys") {
  const PoseCorrections corrections(
      {{2 * kSecond, pose(2.0), pose(2.5, 0.1)}, {kSecond, pose(1.0), pose(1.2)}});
  CHECK(corrections.corrected(kSecond, pose(1.0)).isApprox(pose(1.2), 1e-12));
  CHECK(corrections.corrected(2 * kSecond, pose(2.0)).isApprox(pose(2.5, 0.1), 1e-12));
}

TEST_CASE("between two key scans the correction grows with the time, and outside them it holds") {
  const PoseCorrections corrections({{kSecond, pose(1.0), pose(1.2)}, {2 * kSecond, pose(2.0), pose(2.6)}});
  CHECK(corrections.corrected(3 * kSecond / 2, pose(1.5)).translation().x() == doctest::Approx(1.9));
  CHECK(corrections.corrected(0, pose(0.0)).translation().x() == doctest::Approx(0.2));
  CHECK(corrections.corrected(5 * kSecond, pose(5.0)).translation().x() == doctest::Approx(5.6));
}

TEST_CASE("a turned key scan turns the way after it about the key scan") {
  const PoseCorrections corrections({{kSecond, pose(1.0), pose(1.0, 0.5)}});
  const Eigen::Isometry3d later = corrections.corrected(2 * kSecond, pose(3.0));
  CHECK(later.translation().x() == doctest::Approx(1.0 + 2.0 * std::cos(0.5)));
  CHECK(later.translation().y() == doctest::Approx(2.0 * std::sin(0.5)));
}

}  // namespace
}  // namespace isobar::test::test_pose_corrections

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/mounts/corrected_mount.hpp"

namespace isobar::test::test_corrected_mount {

TEST_CASE("rpy_deg of the corrected mount is the corrected rotation, for any mount") {
  for (const Eigen::Vector3d& rpy_deg :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(10.0, -20.0, 170.0),
        Eigen::Vector3d(180.0, 0.0, 90.0), Eigen::Vector3d(-5.0, 60.0, -120.0),
        Eigen::Vector3d(30.0, 90.0, 10.0)}) {
    for (const Eigen::Vector3d& error_deg :
         {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.5, -0.8, 0.6)}) {
      const Eigen::Vector3d error_rad = error_deg * kRadPerDeg;
      const Eigen::Matrix3d R = rotation_from_rpy_deg(corrected_rpy_deg(rpy_deg, error_rad));
      CHECK((R - corrected_rotation(rpy_deg, error_rad)).norm() < 1e-6);
    }
  }
}

TEST_CASE("an error about the axes of base_link adds to the angles of a level mount") {
  const Eigen::Vector3d found_deg = corrected_rpy_deg({0.0, 0.0, 0.0}, {0.0, 0.01, 0.0});
  CHECK((found_deg - Eigen::Vector3d(0.0, 0.01 / kRadPerDeg, 0.0)).norm() < 1e-12);
  // A lidar that looks backwards: pitch of base_link tilts it against its own pitch.
  CHECK(corrected_rpy_deg({0.0, 0.0, 180.0}, {0.0, 0.01, 0.0}).y() < 0.0);
}

}  // namespace isobar::test::test_corrected_mount

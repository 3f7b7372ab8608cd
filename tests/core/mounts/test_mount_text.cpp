// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/geometry.hpp"
#include "core/mounts/mount_text.hpp"

namespace isobar::test::test_mount_text {

namespace {

MountState found() {
  MountState mount;
  mount.found = mount.yaw_found = true;
  mount.error_rad = {0.5 * kRadPerDeg, -0.25 * kRadPerDeg, 1.0 * kRadPerDeg};
  mount.sigma_rad = {0.06 * kRadPerDeg, 0.07 * kRadPerDeg, 0.1 * kRadPerDeg};
  return mount;
}

}  // namespace

TEST_CASE("the line for the configuration has the corrected mount, its sigma and what was configured") {
  CHECK(mount_line(found(), {0.0, 0.0, 0.0}) ==
        "lidar.rpy_deg = [0.50, -0.25, 1.00]  # +- 0.06, 0.07, 0.10; was [0.00, 0.00, 0.00]");
  MountState mount = found();
  mount.yaw_found = false;
  CHECK(mount_line(mount, {0.0, 0.0, 90.0}) ==
        "lidar.rpy_deg = [-0.25, -0.50, 90.00]  # +- 0.06, 0.07, ?; was [0.00, 0.00, 90.00]");
}

TEST_CASE("mounts.toml is ready for conf.d, and tells the wheels' scale and what was not found") {
  MountState mount = found();
  mount.wheel_distance = {1.0123, 0.0021};
  const std::string text = mounts_file_text(mount, Eigen::Vector3d::Zero());
  CHECK(text.find("\n" + mount_line(mount, Eigen::Vector3d::Zero()) + "\n") != std::string::npos);
  CHECK(text.find("\n# wheels: true distance = 1.0123 x theirs, +- 0.0021\n") != std::string::npos);
  CHECK(text.find("turn") == std::string::npos);
  const std::string nothing = mounts_file_text(MountState{}, Eigen::Vector3d::Zero());
  for (std::size_t at = 0; at < nothing.size(); at = nothing.find('\n', at) + 1) CHECK(nothing[at] == '#');
}

}  // namespace isobar::test::test_mount_text

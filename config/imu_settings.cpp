// SPDX-License-Identifier: BSD-3-Clause
#include "config/mount_settings.hpp"
#include "config/section_builder.hpp"

namespace isobar {

void add_imu_settings(ImuSettings& imu, std::vector<Setting>& settings) {
  SectionBuilder s("imu", UsedBy::kRobot, settings);
  s.choice("source", &imu.source, kImuSourceNames.names(),
           "Source of the IMU's samples; those of any other source are refused. datagram: sample datagrams "
           "by UDP. dds: the ROS 2 topic dds.topics.imu, through isobar-dds. none: this robot has no IMU; "
           "scans are registered as 6-DOF from the wheels or the last motion, and roll, pitch and height "
           "drift with the way.")
      .basic();
  add_position(s, imu.mount, "Origin of the IMU in base_link. 0: at the origin of base_link.");
  add_rotation(s, imu.mount);
}

}  // namespace isobar

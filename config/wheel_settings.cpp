// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {

void add_wheel_settings(WheelSettings& wheel, std::vector<Setting>& settings) {
  SectionBuilder s("wheel", UsedBy::kRobot, settings);
  s.choice("source", &wheel.source, kWheelSourceNames.names(),
           "Source of the wheels' odometry; samples of any other source are refused. datagram: sample "
           "datagrams by UDP; a robot that sends none has none. dds: the ROS 2 topic dds.topics.wheel, "
           "through isobar-dds. none: not used.")
      .basic();
}

}  // namespace isobar

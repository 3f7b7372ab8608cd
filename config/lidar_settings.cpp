// SPDX-License-Identifier: BSD-3-Clause
#include "config/mount_settings.hpp"
#include "config/section_builder.hpp"
#include "drivers/lidar_models/lidar_models.hpp"

namespace isobar {

void add_lidar_settings(LidarSettings& lidar, std::vector<Setting>& settings) {
  SectionBuilder s("lidar", UsedBy::kRobot, settings);
  s.choice("source", &lidar.source, kLidarSourceNames.names(),
           "Source of the lidar's points. driver: its own packets by UDP, those of lidar.model. dds: clouds "
           "of the "
           "ROS 2 topic dds.topics.points, through isobar-dds: any lidar with a ROS 2 driver.")
      .basic();
  s.choice("model", &lidar.model, lidar_model_names(),
           "Model of the lidar. Packets of any other model are refused.")
      .basic();
  s.number("info_port", &lidar.info_port, "", 0, 65'535,
           "UDP port of the lidar's other packets: position, device information, samples of its IMU. 0: the "
           "model's factory setting.");
  s.text("calibration_file", lidar.calibration_file, TextRule::kAny,
         "The sensor's own calibration: the metadata of an Ouster (JSON, needed), the angle corrections of a "
         "Hesai (CSV) or of a RoboSense (CSV). A relative path starts at the folder of this configuration. "
         "Empty: "
         "nominal angles, or those that the sensor sends.");
  s.choice(
      "time", &lidar.time, kLidarTimeNames.names(),
      "Clock that stamps the points. receive: the kernel's receive times, which are late by the time of a "
      "packet: 1 "
      "ms for a VLP-16, 7 to 17 ms for an Ouster. sensor: the lidar's own, where it follows GPS, PPS or PTP "
      "and "
      "this machine's clock the same source (chrony, ptp4l); while it is not locked, or more than 50 ms off, "
      "receive times are used and lidar/clock in the health report says so.");
  s.text("address", lidar.address, TextRule::kIpv4,
         "IPv4 address on which packets are received. 0.0.0.0: every interface.");
  s.number("port", &lidar.port, "", 1, 65'535,
           "UDP port of the data packets. 2368 is the lidar's factory setting.")
      .basic();
  s.text(
      "sender", lidar.sender, TextRule::kIpv4OrEmpty,
      "IPv4 address of the lidar. Packets of other senders are refused and counted. Empty: the first sender "
      "heard is used; another one takes over after 5 s of its silence.");
  add_position(s, lidar.mount, "Origin of the lidar in base_link. 0: at the origin of base_link.");
  add_rotation(s, lidar.mount);
  s.applies(Apply::kLive);
  s.number("min_range_m", &lidar.min_range_m, "m", 0.0, 10.0,
           "Shortest range; the driver drops nearer returns, which come from housing and mount. 0 keeps "
           "all.");
  s.number("max_range_m", &lidar.max_range_m, "m", 1.0, 300.0,
           "Longest range; the driver drops farther returns. 300 keeps all.");
  s.number("mask_start_deg", &lidar.mask_start_deg, "deg", 0.0, 360.0,
           "Start of the masked sector, in which the lidar sees the robot itself: clockwise from above, 0 in "
           "front, across 0 if the end is smaller. Equal start and end mask nothing.");
  s.number("mask_end_deg", &lidar.mask_end_deg, "deg", 0.0, 360.0,
           "End of the masked sector; equal to mask_start_deg, nothing is masked.");
}

}  // namespace isobar

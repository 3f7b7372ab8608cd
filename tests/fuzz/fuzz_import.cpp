// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: containers of messages (not SQLite, whose parser is the library's), the messages in them, files of points,
// flight logs. The first byte of a container tells which; else the first byte chooses the reader.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/import/flight_log.hpp"
#include "run/import/mcap_stream.hpp"
#include "run/import/point_text.hpp"
#include "run/import/ros_messages.hpp"
#include "run/import/rosbag1_stream.hpp"
#include "run/mcap/mcap_format.hpp"

namespace {

using namespace isobar::imports;

void read_as_everything(std::span<const std::uint8_t> bytes, Encoding encoding) {
  const MessageCursor cursor(bytes, encoding);
  MessageHeader header;
  isobar::ImuSample imu;
  isobar::PressureSample pressure;
  isobar::WheelSample wheel;
  OdometryMessage odometry;
  StampedPose pose;
  std::vector<StampedPose> poses;
  CloudMessage cloud;
  PacketsMessage packets;
  (void)read_imu(cursor, header, imu);
  (void)read_pressure(cursor, header, pressure);
  (void)read_twist(cursor, header, wheel);
  (void)read_odometry(cursor, odometry);
  (void)read_pose(cursor, pose);
  (void)read_transforms(cursor, poses);
  (void)read_cloud(cursor, cloud);
  (void)read_livox(cursor, cloud);
  for (const char* type :
       {"velodyne_msgs/VelodyneScan", "pandar_msgs/PandarScan", "nebula_msgs/NebulaPackets",
        "rslidar_msg/RslidarPacket", "ouster_ros/PacketMsg"}) {
    (void)read_packets(type, cursor, packets);
  }
}

void read_all(MessageStream& stream) {
  Message message;
  while (stream.next(message))
    read_as_everything(message.bytes, stream.channels().at(message.channel).encoding);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  static const int memory = memfd_create("import", MFD_CLOEXEC);
  const std::string file = "/proc/self/fd/" + std::to_string(memory);
  const bool is_container = data[0] == static_cast<std::uint8_t>(isobar::mcap::kMagic[0]) || data[0] == '#';
  const std::size_t skip = is_container ? 0 : 1;
  if (ftruncate(memory, 0) != 0 ||
      pwrite(memory, data + skip, size - skip, 0) != static_cast<ssize_t>(size - skip)) {
    return 0;
  }
  std::uint64_t stated_points = 0;
  try {
    if (is_container && data[0] == '#') {
      Rosbag1Stream stream(file);
      read_all(stream);
    } else if (is_container) {
      McapStream stream(file);
      read_all(stream);
    } else if (data[0] == 0) {
      (void)read_pcd(file, stated_points);
    } else if (data[0] == 1) {
      (void)read_ply(file, stated_points);
    } else if (data[0] == 2) {
      (void)read_ulog(file);
    } else if (data[0] == 3) {
      (void)read_dataflash(file);
    } else {
      read_as_everything({data + 1, size - 1}, data[0] == 4 ? Encoding::kRos1 : Encoding::kCdr);
    }
  } catch (const isobar::DataError&) {
    return 0;
  }
  return 0;
}

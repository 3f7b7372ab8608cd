// SPDX-License-Identifier: BSD-3-Clause
// Messages that carry the datagrams of a lidar.
#include <algorithm>
#include <array>
#include <string_view>

#include "run/import/ros_messages.hpp"

namespace isobar::imports {
namespace {

constexpr const char* kShortPackets = "is shorter than its type says";

/// How a type holds its packets.
enum class Layout : std::uint8_t {
  kFixed,       ///< a list of (stamp, array of a fixed length)
  kFixedSized,  ///< a list of (stamp, array of a fixed length, bytes in use)
  kFlagSized,   ///< the same with a byte before the array, as a file of tier4/nebula has it
  kList,        ///< a list of (stamp, sequence)
  kOne,         ///< header, two flags, one sequence
  kBytes,       ///< one sequence, no header
};

struct PacketType {
  std::string_view name;
  Layout layout;
  std::size_t bytes;  ///< of a packet, where fixed
};

/// Definitions of the packages of the same names, as their makers and drivers publish them.
constexpr std::array kPacketTypes{
    PacketType{"velodyne_msgs/VelodyneScan", Layout::kFixed, 1206},
    PacketType{"pandar_msgs/PandarScan", Layout::kFixedSized, 1500},
    PacketType{"hesai_lidar/PandarScan", Layout::kFixedSized, 1500},
    PacketType{"nebula_msgs/NebulaPackets", Layout::kList, 0},
    PacketType{"hesai_ros_driver/UdpFrame", Layout::kList, 0},
    PacketType{"robosense_msgs/RobosenseScan", Layout::kFlagSized, 1500},
    PacketType{"rslidar_msgs/rslidarScan", Layout::kFixed, 1248},
    PacketType{"rslidar_msg/RslidarPacket", Layout::kOne, 0},
    PacketType{"ouster_ros/PacketMsg", Layout::kBytes, 0},
    PacketType{"ouster_msgs/PacketMsg", Layout::kBytes, 0},
    PacketType{"ouster_sensor_msgs/PacketMsg", Layout::kBytes, 0},
};

const PacketType* find_type(const std::string& name) {
  const auto found = std::find_if(kPacketTypes.begin(), kPacketTypes.end(),
                                  [&](const PacketType& type) { return type.name == name; });
  return found == kPacketTypes.end() ? nullptr : &*found;
}

void read_packet(const PacketType& type, MessageCursor& cursor, PacketOfMessage& packet) {
  packet.stamp_ns = cursor.time_ns();
  if (type.layout == Layout::kFlagSized) cursor.take(1);
  auto bytes = type.layout == Layout::kList ? cursor.blob() : cursor.take(type.bytes);
  if (type.layout == Layout::kFixedSized || type.layout == Layout::kFlagSized) {
    bytes = bytes.first(std::min<std::size_t>(cursor.get<std::uint32_t>(), bytes.size()));
  }
  packet.bytes.assign(bytes.begin(), bytes.end());
}

}  // namespace

bool holds_packets(const std::string& type) { return find_type(type) != nullptr; }

const char* read_packets(const std::string& type_name, MessageCursor cursor, PacketsMessage& message) {
  const PacketType* type = find_type(type_name);
  if (type == nullptr) return "is of a type that holds no packets";
  message.header = {};
  message.packets.clear();
  if (type->layout != Layout::kBytes) {
    if (cursor.is_ros1()) cursor.get<std::uint32_t>();  // seq
    message.header.stamp_ns = cursor.time_ns();
    message.header.frame_id = cursor.text();
  }
  if (type->layout == Layout::kOne || type->layout == Layout::kBytes) {
    if (type->layout == Layout::kOne) cursor.take(2);  // is_difop, is_frame_begin
    const auto bytes = cursor.blob();
    message.packets.push_back({message.header.stamp_ns, {bytes.begin(), bytes.end()}});
    return cursor.ok() ? nullptr : kShortPackets;
  }
  const std::uint32_t count = cursor.count(sizeof(std::uint64_t) + type->bytes);
  message.packets.resize(count);
  for (PacketOfMessage& packet : message.packets) {
    read_packet(*type, cursor, packet);
    if (!cursor.ok()) break;
  }
  return cursor.ok() ? nullptr : kShortPackets;
}

}  // namespace isobar::imports

// SPDX-License-Identifier: BSD-3-Clause
// Messages of clouds.
#include <cstring>

#include "run/import/ros_messages.hpp"

namespace isobar::imports {
namespace {

constexpr const char* kShortCloud = "is shorter than its type says";
constexpr std::uint32_t kMostCloudFields = 256;

void read_cloud_header(MessageCursor& cursor, MessageHeader& header) {
  if (cursor.is_ros1()) cursor.get<std::uint32_t>();  // seq
  header.stamp_ns = cursor.time_ns();
  header.frame_id = cursor.text();
}

template <typename Value>
void append(std::vector<std::uint8_t>& to, Value value) {
  const std::size_t at = to.size();
  to.resize(at + sizeof(Value));
  std::memcpy(&to[at], &value, sizeof(Value));
}

}  // namespace

const char* read_cloud(MessageCursor cursor, CloudMessage& message) {
  constexpr std::size_t kLeastFieldBytes = 13;
  recording::CloudRecord& cloud = message.cloud;
  read_cloud_header(cursor, message.header);
  cloud.stamp_ns = message.header.stamp_ns;
  cloud.shift_ns = 0;
  cloud.height = cursor.get<std::uint32_t>();
  cloud.width = cursor.get<std::uint32_t>();
  const std::uint32_t fields = cursor.count(kLeastFieldBytes);
  if (fields > kMostCloudFields) return "has more than 256 fields";
  cloud.fields.resize(fields);
  for (recording::CloudRecordField& field : cloud.fields) {
    field.name = cursor.text();
    field.offset = cursor.get<std::uint32_t>();
    field.datatype = cursor.get<std::uint8_t>();
    const auto values = cursor.get<std::uint32_t>();
    // An array of values in one field is no coordinate.
    if (values > 1) field.name += "[]";
  }
  cloud.is_bigendian = cursor.get<std::uint8_t>() != 0;
  cloud.point_step = cursor.get<std::uint32_t>();
  cloud.row_step = cursor.get<std::uint32_t>();
  const auto data = cursor.blob();
  if (!cursor.ok()) return kShortCloud;
  cloud.data.assign(data.begin(), data.end());
  return nullptr;
}

const char* read_livox(MessageCursor cursor, CloudMessage& message) {
  constexpr std::size_t kPackedBytes = 19;  // offset_time, x, y, z, reflectivity, tag, line
  constexpr std::uint32_t kStep = 22;
  // Value of bits 0-1 (place) and 2-3 (intensity) of a tag for a doubtful return; drivers/livox drops them, too.
  constexpr unsigned kDoubtful = 2;
  read_cloud_header(cursor, message.header);
  cursor.get<std::uint64_t>();  // time of the first point, on the sensor's clock
  cursor.get<std::uint32_t>();  // number of points
  cursor.take(4);               // id, reserved
  const std::uint32_t count = cursor.count(kPackedBytes);
  recording::CloudRecord& cloud = message.cloud;
  cloud = {};
  cloud.stamp_ns = message.header.stamp_ns;
  cloud.point_step = kStep;
  cloud.height = 1;
  cloud.fields = {{"x", 0, 7},          {"y", 4, 7},     {"z", 8, 7},
                  {"intensity", 12, 7}, {"line", 16, 4}, {"offset_time", 18, 6}};
  cloud.data.reserve(std::size_t{count} * kStep);
  for (std::uint32_t i = 0; i < count && cursor.ok(); ++i) {
    const auto offset_ns = cursor.get<std::uint32_t>();
    const auto x = cursor.get<float>();
    const auto y = cursor.get<float>();
    const auto z = cursor.get<float>();
    const auto reflectivity = cursor.get<std::uint8_t>();
    const auto tag = cursor.get<std::uint8_t>();
    const auto line = cursor.get<std::uint8_t>();
    if ((tag & 3U) == kDoubtful || (tag >> 2U & 3U) == kDoubtful) continue;
    for (const float coordinate : {x, y, z, static_cast<float>(reflectivity)}) append(cloud.data, coordinate);
    append(cloud.data, std::uint16_t{line});
    append(cloud.data, offset_ns);
  }
  if (!cursor.ok()) return kShortCloud;
  cloud.width = static_cast<std::uint32_t>(cloud.data.size() / kStep);
  cloud.row_step = cloud.width * kStep;
  return nullptr;
}

}  // namespace isobar::imports

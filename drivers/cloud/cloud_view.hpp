// SPDX-License-Identifier: BSD-3-Clause
// A point cloud as sensor_msgs/PointCloud2 lays it out, without its transport.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace isobar {

/// sensor_msgs/PointField: datatype.
enum class CloudType : std::uint8_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kFloat32 = 7,
  kFloat64 = 8,
};

/// Bytes of a value; 0 for a number that is no type.
[[nodiscard]] std::size_t size_of(CloudType type);

/// One field of each point.
struct CloudField {
  std::string_view name;
  std::uint32_t offset = 0;  ///< in a point [bytes]
  CloudType type = CloudType::kFloat32;
};

/// A message. Nothing of it has been checked.
struct CloudView {
  std::span<const CloudField> fields;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;  ///< [bytes]
  std::uint32_t row_step = 0;    ///< [bytes]
  bool is_bigendian = false;
  std::span<const std::uint8_t> data;
  std::int64_t stamp_ns = 0;  ///< of the header
};

/// The value of a field of a point at `point`, in the byte order of the message.
[[nodiscard]] double value_of(const std::uint8_t* point, const CloudField& field, bool is_bigendian);

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/cloud/cloud_view.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace isobar {
namespace {

template <class Value>
double read(const std::uint8_t* at, bool is_bigendian) {
  std::array<std::uint8_t, sizeof(Value)> bytes{};
  std::copy_n(at, sizeof(Value), bytes.begin());
  if (is_bigendian) std::reverse(bytes.begin(), bytes.end());
  Value value{};
  std::memcpy(&value, bytes.data(), sizeof(Value));
  return static_cast<double>(value);
}

}  // namespace

std::size_t size_of(CloudType type) {
  switch (type) {
    case CloudType::kInt8:
    case CloudType::kUint8:
      return 1;
    case CloudType::kInt16:
    case CloudType::kUint16:
      return 2;
    case CloudType::kInt32:
    case CloudType::kUint32:
    case CloudType::kFloat32:
      return 4;
    case CloudType::kFloat64:
      return 8;
  }
  return 0;
}

double value_of(const std::uint8_t* point, const CloudField& field, bool is_bigendian) {
  const std::uint8_t* at = point + field.offset;
  switch (field.type) {
    case CloudType::kInt8:
      return read<std::int8_t>(at, is_bigendian);
    case CloudType::kUint8:
      return read<std::uint8_t>(at, is_bigendian);
    case CloudType::kInt16:
      return read<std::int16_t>(at, is_bigendian);
    case CloudType::kUint16:
      return read<std::uint16_t>(at, is_bigendian);
    case CloudType::kInt32:
      return read<std::int32_t>(at, is_bigendian);
    case CloudType::kUint32:
      return read<std::uint32_t>(at, is_bigendian);
    case CloudType::kFloat32:
      return read<float>(at, is_bigendian);
    case CloudType::kFloat64:
      return read<double>(at, is_bigendian);
  }
  return 0.0;
}

}  // namespace isobar

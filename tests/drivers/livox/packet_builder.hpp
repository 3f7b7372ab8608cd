// SPDX-License-Identifier: BSD-3-Clause
// Builder of Mid-360 packets from Livox's protocol document, chapters 2 and 6, without the project's format
// constants: independent of the decoder. CRC-32 by zlib, whose parameters are those of chapter 6.
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace isobar::test {

struct LivoxPoint {
  int x_mm = 0, y_mm = 0, z_mm = 0;
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
};

class LivoxPacket {
 public:
  std::uint64_t timestamp_ns = 0;
  std::uint16_t time_interval = 4'750;  // 0.1 us, first to last of 96 points at 200 kHz
  std::uint16_t udp_cnt = 0;
  std::uint8_t time_type = 0;

  /// data_type 1: mm in 32 bits.
  [[nodiscard]] std::vector<std::uint8_t> points(const std::vector<LivoxPoint>& list) const {
    std::vector<std::uint8_t> data;
    for (const LivoxPoint& point : list) {
      for (const int value : {point.x_mm, point.y_mm, point.z_mm})
        put(data, static_cast<std::uint32_t>(value), 4);
      data.push_back(point.reflectivity);
      data.push_back(point.tag);
    }
    return finish(1, list.size(), data);
  }
  /// data_type 2: cm in 16 bits.
  [[nodiscard]] std::vector<std::uint8_t> short_points(const std::vector<LivoxPoint>& list) const {
    std::vector<std::uint8_t> data;
    for (const LivoxPoint& point : list) {
      for (const int value : {point.x_mm, point.y_mm, point.z_mm})
        put(data, static_cast<std::uint16_t>(value / 10), 2);
      data.push_back(point.reflectivity);
      data.push_back(point.tag);
    }
    return finish(2, list.size(), data);
  }
  /// data_type 0.
  [[nodiscard]] std::vector<std::uint8_t> imu(const std::array<float, 3>& gyro_rad_s,
                                              const std::array<float, 3>& accel_g) const {
    std::vector<std::uint8_t> data(24);
    std::memcpy(data.data(), gyro_rad_s.data(), 12);
    std::memcpy(data.data() + 12, accel_g.data(), 12);
    return finish(0, 1, data);
  }
  /// Any data_type.
  [[nodiscard]] std::vector<std::uint8_t> finish(std::uint8_t data_type, std::size_t dots,
                                                 const std::vector<std::uint8_t>& data) const {
    std::vector<std::uint8_t> checked;
    put(checked, timestamp_ns, 8);
    checked.insert(checked.end(), data.begin(), data.end());
    std::vector<std::uint8_t> bytes;
    bytes.push_back(0);
    put(bytes, 28 + checked.size(), 2);
    put(bytes, time_interval, 2);
    put(bytes, dots, 2);
    put(bytes, udp_cnt, 2);
    bytes.push_back(0);
    bytes.push_back(data_type);
    bytes.push_back(time_type);
    put(bytes, 0, 8);
    put(bytes, 0, 4);
    put(bytes, ::crc32(0, checked.data(), static_cast<unsigned>(checked.size())), 4);
    bytes.insert(bytes.end(), checked.begin(), checked.end());
    return bytes;
  }

 private:
  static void put(std::vector<std::uint8_t>& bytes, std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
};

}  // namespace isobar::test

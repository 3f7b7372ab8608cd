// SPDX-License-Identifier: BSD-3-Clause
// Writes binary packets of a VN-100 field by field.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "drivers/vn100/binary_packet.hpp"

namespace isobar::test {

class PacketWriter {
 public:
  explicit PacketWriter(std::vector<std::uint8_t> header) : bytes_(std::move(header)) {}
  PacketWriter& number(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
  PacketWriter& real(float value) { return number(std::bit_cast<std::uint32_t>(value), 4); }
  PacketWriter& reals(std::initializer_list<float> values) {
    for (const float value : values) real(value);
    return *this;
  }
  /// Appends the CRC, most significant byte first.
  [[nodiscard]] std::vector<std::uint8_t> finish() const {
    std::vector<std::uint8_t> packet = bytes_;
    const std::uint16_t crc = vn100::crc16(std::span(packet).subspan(1));
    packet.push_back(static_cast<std::uint8_t>(crc >> 8U));
    packet.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    return packet;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// A packet of the output that the driver sets up: TimeStartup, Imu; Temp, Pres.
inline std::vector<std::uint8_t> own_packet(std::uint64_t time_ns, float gyro_z_rad_s = 0.25F,
                                            float pressure_kpa = 101.325F) {
  return PacketWriter({0xFA, 0x05, 0x01, 0x02, 0x30, 0x00})
      .number(time_ns, 8)
      .reals({0.1F, -0.2F, -9.8F, 0.01F, -0.02F, gyro_z_rad_s})
      .reals({21.5F, pressure_kpa})
      .finish();
}

}  // namespace isobar::test

// SPDX-License-Identifier: BSD-3-Clause
// Builder of RoboSense packets from the user manuals, without the project's format constants: independent of the
// decoder.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace isobar::test {

struct RobosensePlan {
  bool is_helios = true;
  std::int64_t time_us = 1'732'848'127'250'000;  // since 1970; 2024-11-29 02:42:07.25
  double first_azimuth_deg = 0.0;
  double step_deg = 0.4;  // from block to block: 111 us at 10 Hz
  /// Distance in counts by block and channel.
  std::function<std::uint16_t(int, int)> distance = [](int, int) { return std::uint16_t{2'000}; };
};

inline void put_big(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFFU));
}

inline std::vector<std::uint8_t> build_packet(const RobosensePlan& plan) {
  std::vector<std::uint8_t> bytes =
      plan.is_helios ? std::vector<std::uint8_t>{0x55, 0xAA, 0x05, 0x5A, 0, 1, 0, 0}
                     : std::vector<std::uint8_t>{0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0};
  bytes.resize(20);
  if (plan.is_helios) {
    put_big(bytes, static_cast<std::uint64_t>(plan.time_us / 1'000'000), 6);
    put_big(bytes, static_cast<std::uint64_t>(plan.time_us % 1'000'000), 4);
  } else {
    const auto us = static_cast<std::uint64_t>(plan.time_us % 1'000'000);
    for (const int part : {24, 11, 29, 2, 42, 7}) put_big(bytes, static_cast<std::uint64_t>(part), 1);
    put_big(bytes, us / 1'000, 2);
    put_big(bytes, us % 1'000, 2);
  }
  put_big(bytes, plan.is_helios ? 6 : 1, 1);
  bytes.resize(42);
  for (int block = 0; block < 12; ++block) {
    put_big(bytes, 0xFFEE, 2);
    const double azimuth_deg = std::fmod(plan.first_azimuth_deg + block * plan.step_deg, 360.0);
    put_big(bytes, static_cast<std::uint64_t>(std::lround(azimuth_deg * 100.0)) % 36'000U, 2);
    for (int channel = 0; channel < 32; ++channel) {
      put_big(bytes, plan.distance(block, channel), 2);
      put_big(bytes, static_cast<std::uint64_t>(channel), 1);
    }
  }
  bytes.resize(1'248);
  return bytes;
}

/// Device information of a Helios. Angles in 0.01 deg.
inline std::vector<std::uint8_t> build_helios_difop(const std::vector<int>& elevations,
                                                    const std::vector<int>& azimuths,
                                                    std::uint8_t return_mode) {
  std::vector<std::uint8_t> bytes{0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
  put_big(bytes, 600, 2);
  bytes.resize(300);
  bytes.push_back(return_mode);
  bytes.push_back(0);
  bytes.push_back(1);  // synchronised
  bytes.resize(468);
  for (const auto* angles : {&elevations, &azimuths}) {
    for (std::size_t i = 0; i < 32; ++i) {
      const int angle = i < angles->size() ? (*angles)[i] : 0;
      put_big(bytes, angle < 0 ? 1 : 0, 1);
      put_big(bytes, static_cast<std::uint64_t>(std::abs(angle)), 2);
    }
  }
  bytes.resize(1'248);
  return bytes;
}

}  // namespace isobar::test

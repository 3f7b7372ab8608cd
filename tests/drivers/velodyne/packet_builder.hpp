// SPDX-License-Identifier: BSD-3-Clause
// Builder of Velodyne packets from the manuals, without the project's format constants: independent of the
// decoder.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace isobar::test {

struct PacketPlan {
  std::uint8_t product_id = 0x22;
  std::uint8_t return_mode = 0x37;
  std::uint32_t timestamp_us = 0;
  double first_azimuth_deg = 0.0;
  double step_deg = 0.2;               // from firing block to firing block
  std::vector<double> azimuths_deg{};  // of the blocks, where they do not follow from these two
  /// Distance in units of 2 mm by block and channel.
  std::function<std::uint16_t(int, int)> distance = [](int, int) { return std::uint16_t{2'500}; };
};

inline std::vector<std::uint8_t> build_packet(const PacketPlan& plan) {
  std::vector<std::uint8_t> bytes;
  const auto put16 = [&bytes](unsigned value) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  };
  for (int block = 0; block < 12; ++block) {
    const int firing = plan.return_mode == 0x39 ? block / 2 : block;
    const double azimuth_deg = plan.azimuths_deg.empty()
                                   ? std::fmod(plan.first_azimuth_deg + firing * plan.step_deg, 360.0)
                                   : plan.azimuths_deg[static_cast<std::size_t>(block)];
    bytes.push_back(0xFF);
    bytes.push_back(0xEE);
    put16(static_cast<unsigned>(std::lround(azimuth_deg * 100.0)) % 36'000U);
    for (int channel = 0; channel < 32; ++channel) {
      put16(plan.distance(block, channel));
      bytes.push_back(static_cast<std::uint8_t>(channel));  // reflectivity: tells the channels apart
    }
  }
  put16(plan.timestamp_us & 0xFFFFU);
  put16(plan.timestamp_us >> 16U);
  bytes.push_back(plan.return_mode);
  bytes.push_back(plan.product_id);
  return bytes;
}

}  // namespace isobar::test

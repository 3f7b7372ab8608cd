// SPDX-License-Identifier: BSD-3-Clause
// Builder of Hesai XT packets from the user manuals, without the project's format constants: independent of the
// decoder.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace isobar::test {

struct HesaiPlan {
  int lasers = 16;
  std::uint8_t return_mode = 0x37;
  std::vector<std::uint8_t> date{124, 11, 29, 2, 42, 7};  // years since 1900 …
  std::uint32_t microsecond = 0;
  double first_azimuth_deg = 0.0;
  double step_deg = 0.18;  // from firing to firing: 50 us at 10 Hz
  std::uint32_t sequence = 1;
  /// Distance in units of 4 mm by block and channel.
  std::function<std::uint16_t(int, int)> distance = [](int, int) { return std::uint16_t{1'000}; };
};

inline std::vector<std::uint8_t> build_packet(const HesaiPlan& plan) {
  std::vector<std::uint8_t> bytes{0xEE, 0xFF, 6, 1, 0, 0, static_cast<std::uint8_t>(plan.lasers),
                                  8,    1,    4, 1, 1};
  const auto put = [&bytes](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFFU));
  };
  const bool dual = plan.return_mode == 0x39 || plan.return_mode == 0x3B || plan.return_mode == 0x3C;
  bytes[10] = dual ? 2 : 1;
  for (int block = 0; block < 8; ++block) {
    const double azimuth_deg =
        std::fmod(plan.first_azimuth_deg + (dual ? block / 2 : block) * plan.step_deg, 360.0);
    put(static_cast<std::uint32_t>(std::lround(azimuth_deg * 100.0)) % 36'000U, 2);
    for (int channel = 0; channel < plan.lasers; ++channel) {
      put(plan.distance(block, channel), 2);
      put(static_cast<std::uint32_t>(channel), 1);  // reflectivity: tells the channels apart
      put(0, 1);
    }
  }
  for (int i = 0; i < 10; ++i) put(0, 1);
  put(plan.return_mode, 1);
  put(600, 2);
  for (const std::uint8_t part : plan.date) put(part, 1);
  put(plan.microsecond, 4);
  put(0x42, 1);
  put(plan.sequence, 4);
  return bytes;
}

}  // namespace isobar::test

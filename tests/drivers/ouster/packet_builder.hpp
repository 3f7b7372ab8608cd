// SPDX-License-Identifier: BSD-3-Clause
// Builder of Ouster packets and metadata from the sensor documentation, without the project's format constants:
// independent of the decoder.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace isobar::test {

struct OusterReturn {
  std::uint32_t range_mm = 0;
  std::uint32_t reflectivity = 0;
};

struct OusterPlan {
  std::string profile = "RNG19_RFL8_SIG16_NIR16";
  int rows = 32;
  int columns_per_packet = 16;
  int columns_per_turn = 1'024;
  double hz = 10.0;
  int first_id = 0;
  std::uint64_t first_ns = 1'000'000'000;
  std::uint16_t frame_id = 7;
  std::uint32_t init_id = 0x123456;
  std::uint64_t serial = 122'000'000'001;
  std::function<bool(int id)> is_valid = [](int) { return true; };
  /// Return 0 or 1 of a row at a measurement id.
  std::function<OusterReturn(int id, int row, int number)> target = [](int id, int row, int number) {
    return OusterReturn{static_cast<std::uint32_t>(8 * (500 + id % 100 + row + 200 * number)),
                        static_cast<std::uint32_t>((id + row) % 251)};
  };
};

std::vector<std::uint8_t> build_ouster_packet(const OusterPlan& plan);

/// LEGACY IMU packet; acceleration in g, angular rate in deg/s.
std::vector<std::uint8_t> build_ouster_imu(std::uint64_t gyro_ns, const std::array<float, 3>& accel_g,
                                           const std::array<float, 3>& gyro_deg_s);
/// ACCEL32_GYRO32_NMEA packet; m/s^2 and rad/s, the same in every sample.
std::vector<std::uint8_t> build_ouster_imu_block(std::uint64_t first_ns, int samples,
                                                 const std::array<float, 3>& accel_m_s2,
                                                 const std::array<float, 3>& gyro_rad_s,
                                                 int invalid_sample = -1);

/// Metadata that fits the plan's packets.
/// @param nested the form of firmware 3.x; else that of 2.x
std::string build_ouster_metadata(const OusterPlan& plan, bool nested,
                                  const std::string& product = "OS-1-32");

}  // namespace isobar::test

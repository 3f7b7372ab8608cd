// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/ouster/packet_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace isobar::test {
namespace {

using ByteList = std::vector<std::uint8_t>;

void put(ByteList& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i, value >>= 8U) bytes.push_back(static_cast<std::uint8_t>(value));
}

void put_float(ByteList& bytes, float value) {
  std::uint32_t raw = 0;
  std::memcpy(&raw, &value, sizeof raw);
  put(bytes, raw, 4);
}

void put_pixel(ByteList& bytes, const OusterPlan& plan, int id, int row) {
  const OusterReturn one = plan.target(id, row, 0);
  const OusterReturn two = plan.target(id, row, 1);
  const auto short_return = [&bytes](const OusterReturn& r, bool flag, std::uint64_t last) {
    put(bytes, r.range_mm / 8 | (flag ? 0x8000U : 0U), 2);
    put(bytes, r.reflectivity, 1);
    put(bytes, last, 1);
  };
  const auto long_return = [&bytes](const OusterReturn& r) {
    put(bytes, (r.range_mm & 0x7FFFFU) | 0xA8'0000U, 3);  // flags above the range
    put(bytes, r.reflectivity, 1);
  };
  if (plan.profile == "LEGACY") {
    put(bytes, (one.range_mm & 0xF'FFFFU) | 0x9000'0000U, 4);
    put(bytes, one.reflectivity, 2);
    put(bytes, 0x4444'5555'6666, 6);
  } else if (plan.profile == "RNG19_RFL8_SIG16_NIR16") {
    put(bytes, (one.range_mm & 0x7FFFFU) | 0xA8'0000U, 4);
    put(bytes, one.reflectivity, 1);
    put(bytes, 0x77'5555'6666'7700, 7);
  } else if (plan.profile == "RNG19_RFL8_SIG16_NIR16_DUAL") {
    long_return(one);
    long_return(two);
    put(bytes, 0x1111'2222'3333, 8);
  } else if (plan.profile == "RNG15_RFL8_NIR8") {
    short_return(one, true, 0x99);
  } else {
    short_return(one, true, 0x99);
    short_return(two, true, 0);
  }
}

/// Packet header of 32 bytes.
void put_header(ByteList& bytes, const OusterPlan& plan) {
  if (plan.profile.starts_with("FUSA")) {
    put(bytes, 1, 1);
    put(bytes, plan.init_id, 3);
    put(bytes, plan.frame_id, 4);
    put(bytes, 0, 3);
    put(bytes, plan.serial, 5);
  } else {
    put(bytes, 1, 2);
    put(bytes, plan.frame_id, 2);
    put(bytes, plan.init_id, 3);
    put(bytes, plan.serial, 5);
    put(bytes, 0, 4);
  }
  put(bytes, 0, 16);
}

}  // namespace

std::vector<std::uint8_t> build_ouster_packet(const OusterPlan& plan) {
  const bool legacy = plan.profile == "LEGACY";
  const double column_ns = 1e9 / (plan.columns_per_turn * plan.hz);
  ByteList bytes;
  if (!legacy) put_header(bytes, plan);
  for (int i = 0; i < plan.columns_per_packet; ++i) {
    const int id = plan.first_id + i;
    const bool valid = plan.is_valid(id);
    put(bytes, valid ? plan.first_ns + static_cast<std::uint64_t>(std::llround(i * column_ns)) : 0, 8);
    put(bytes, static_cast<std::uint64_t>(id), 2);
    put(bytes, legacy ? plan.frame_id : valid ? 1U : 0U, 2);
    if (legacy)
      put(bytes, static_cast<std::uint64_t>(id) * 90'112 / static_cast<std::uint64_t>(plan.columns_per_turn),
          4);
    for (int row = 0; row < plan.rows; ++row) put_pixel(bytes, plan, id, row);
    if (legacy) put(bytes, valid ? 0xFFFF'FFFF : 0, 4);
  }
  if (!legacy) put(bytes, 0, 32);
  return bytes;
}

std::vector<std::uint8_t> build_ouster_imu(std::uint64_t gyro_ns, const std::array<float, 3>& accel_g,
                                           const std::array<float, 3>& gyro_deg_s) {
  ByteList bytes;
  put(bytes, 77, 8);
  put(bytes, gyro_ns - 200'000, 8);
  put(bytes, gyro_ns, 8);
  for (const float value : accel_g) put_float(bytes, value);
  for (const float value : gyro_deg_s) put_float(bytes, value);
  return bytes;
}

std::vector<std::uint8_t> build_ouster_imu_block(std::uint64_t first_ns, int samples,
                                                 const std::array<float, 3>& accel_m_s2,
                                                 const std::array<float, 3>& gyro_rad_s, int invalid_sample) {
  ByteList bytes(32 + 100, 0);
  bytes[0] = 2;
  for (int i = 0; i < samples; ++i) {
    put(bytes, first_ns + static_cast<std::uint64_t>(i) * 1'562'500, 8);
    put(bytes, static_cast<std::uint64_t>(i), 2);
    put(bytes, i == invalid_sample ? 0 : 1, 2);
    for (const float value : accel_m_s2) put_float(bytes, value);
    for (const float value : gyro_rad_s) put_float(bytes, value);
  }
  bytes.resize(bytes.size() + 32, 0);
  return bytes;
}

std::string build_ouster_metadata(const OusterPlan& plan, bool nested, const std::string& product) {
  using nlohmann::json;
  json altitude = json::array();
  json azimuth = json::array();
  for (int row = 0; row < plan.rows; ++row) {
    altitude.push_back(plan.rows < 2 ? 0.0 : 22.5 - 45.0 * row / (plan.rows - 1));
    azimuth.push_back(row % 4 * 2.8 - 4.2);
  }
  const json lidar{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};
  const json imu{1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1};
  const std::string mode =
      std::to_string(plan.columns_per_turn) + "x" + std::to_string(static_cast<int>(plan.hz));
  json format{{"columns_per_frame", plan.columns_per_turn},
              {"columns_per_packet", plan.columns_per_packet},
              {"pixels_per_column", plan.rows}};
  if (nested || plan.profile != "LEGACY") format["udp_profile_lidar"] = plan.profile;
  json root;
  json& sensor = nested ? root["sensor_info"] : root;
  sensor["prod_line"] = product;
  sensor["prod_sn"] = std::to_string(plan.serial);
  sensor["initialization_id"] = plan.init_id;
  json& beams = nested ? root["beam_intrinsics"] : root;
  beams["beam_altitude_angles"] = altitude;
  beams["beam_azimuth_angles"] = azimuth;
  beams["lidar_origin_to_beam_origin_mm"] = 15.806;
  (nested ? root["lidar_intrinsics"] : root)["lidar_to_sensor_transform"] = lidar;
  (nested ? root["imu_intrinsics"] : root)["imu_to_sensor_transform"] = imu;
  json& config = nested ? root["config_params"] : root;
  config["lidar_mode"] = mode;
  if (nested) config["timestamp_mode"] = "TIME_FROM_PTP_1588";
  root[nested ? "lidar_data_format" : "data_format"] = format;
  return root.dump(2);
}

}  // namespace isobar::test

// SPDX-License-Identifier: BSD-3-Clause
// Lidar packets and metadata of Ouster (firmware user manual 2.x, "Lidar Data Packet Format" and "Sensor Metadata"),
// profile RNG19_RFL8_SIG16_NIR16: a header of 32 bytes, 16 columns of 12 bytes and 12 bytes a pixel, a footer of 32.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "simulation/lidar_packet.hpp"

namespace isobar::simulation {

namespace {

constexpr std::uint64_t kSerial = 122'400'000'123;
constexpr std::uint32_t kInitId = 0x1A'2B3C;
constexpr double kMaxRangeMm = 0x7FFFF;

void put_pixel(PacketBytes& bytes, const LidarPlan& plan, const LaserReturn& measured) {
  // The range counts from the axis to the beam's origin and on along the beam.
  const double mm = std::round(1e3 * (measured.distance_m + plan.origin_radius_m));
  const bool returned = measured.distance_m > 0.0 && mm <= kMaxRangeMm;
  put_little(bytes, returned ? static_cast<std::uint64_t>(mm) : 0, 4);
  put_little(bytes, returned ? measured.reflectivity : 0, 1);
  put_little(bytes, 0, 1);
  put_little(bytes, returned ? 4U * measured.reflectivity : 0, 2);  // signal photons
  put_little(bytes, 90, 2);                                         // near infrared: daylight
  put_little(bytes, 0, 2);
}

std::string list_text(const LidarPlan& plan, const LidarPlan::Angles& angles_deg) {
  std::string text = "[";
  for (std::size_t i = 0; i < plan.lasers; ++i) {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "%s%.6f", i == 0 ? "" : ", ", angles_deg[i]);
    text += number.data();
  }
  return text + "]";
}

/// The row-major matrix of a rotation about z by `cosine` 1 or -1 (half a turn) and a translation [mm].
std::string transform_text(int cosine, const std::array<double, 3>& mm) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "[%d, 0, 0, %g, 0, %d, 0, %g, 0, 0, 1, %g, 0, 0, 0, 1]", cosine,
                mm[0], cosine, mm[1], mm[2]);
  return text.data();
}

}  // namespace

PacketBytes encode_ouster(const LidarPlan& plan, const LidarPacket& packet) {
  const std::uint64_t first = packet.number * packet.cycles.size();
  PacketBytes bytes;
  bytes.reserve(64 + packet.cycles.size() * (12 + 12 * plan.lasers));
  put_little(bytes, 1, 2);                     // lidar data
  put_little(bytes, first / plan.columns, 2);  // number of the turn
  put_little(bytes, kInitId, 3);
  put_little(bytes, kSerial, 5);
  bytes.resize(32);
  for (std::size_t i = 0; i < packet.cycles.size(); ++i) {
    const double column_s = packet.sensor_s + packet.cycle_s * static_cast<double>(i);
    put_little(bytes, static_cast<std::uint64_t>(std::llround(1e9 * column_s)), 8);
    put_little(bytes, (first + i) % plan.columns, 2);
    put_little(bytes, 1, 2);  // valid
    for (std::size_t laser = 0; laser < plan.lasers; ++laser) {
      put_pixel(bytes, plan, packet.cycles[i].returns[laser]);
    }
  }
  bytes.resize(bytes.size() + 32);
  return bytes;
}

std::string ouster_metadata(const LidarPlan& plan) {
  const std::string columns = std::to_string(plan.columns);
  const std::string lasers = std::to_string(plan.lasers);
  const std::string product = "OS-" + std::string(plan.name.substr(2)) + "-" + lasers;
  std::array<char, 32> radius_mm{};
  std::snprintf(radius_mm.data(), radius_mm.size(), "%.3f", 1e3 * plan.origin_radius_m);
  return "{\n  \"prod_line\": \"" + product + "\",\n  \"prod_sn\": \"" + std::to_string(kSerial) +
         "\",\n  \"initialization_id\": " + std::to_string(kInitId) + ",\n  \"lidar_mode\": \"" + columns +
         "x10\",\n  \"udp_port_lidar\": " + std::to_string(plan.port) +
         ",\n  \"data_format\": {\n    \"columns_per_frame\": " + columns +
         ",\n    \"columns_per_packet\": " + std::to_string(plan.cycles) +
         ",\n    \"pixels_per_column\": " + lasers + ",\n    \"column_window\": [0, " +
         std::to_string(plan.columns - 1) +
         "],\n    \"udp_profile_lidar\": \"RNG19_RFL8_SIG16_NIR16\"\n  },\n  \"beam_altitude_angles\": " +
         list_text(plan, plan.elevation_deg) +
         ",\n  \"beam_azimuth_angles\": " + list_text(plan, plan.azimuth_ahead_deg) +
         ",\n  \"lidar_origin_to_beam_origin_mm\": " + radius_mm.data() +
         ",\n  \"lidar_to_sensor_transform\": " + transform_text(-1, {0.0, 0.0, 1e3 * plan.origin_height_m}) +
         ",\n  \"imu_to_sensor_transform\": " + transform_text(1, {6.253, -11.775, 7.645}) + "\n}\n";
}

}  // namespace isobar::simulation

// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/robosense/device_information.hpp"

namespace isobar::robosense {
namespace {

constexpr std::size_t kHeliosElevations = 468;
constexpr std::size_t kHeliosAzimuths = 564;
constexpr std::size_t kRs16Elevations = 1'165;
constexpr std::size_t kAngleBytes = 3;

/// Sign byte, then 0.01 deg.
double helios_angle_deg(const std::uint8_t* at) {
  const double magnitude_deg = 0.01 * be16(at + 1);
  return at[0] == 0 ? magnitude_deg : -magnitude_deg;
}

AngleTable helios_angles(const std::uint8_t* packet, std::size_t lasers) {
  AngleTable table;
  for (std::size_t i = 0; i < lasers; ++i) {
    table.elevation_deg.push_back(helios_angle_deg(packet + kHeliosElevations + i * kAngleBytes));
    table.azimuth_deg.push_back(helios_angle_deg(packet + kHeliosAzimuths + i * kAngleBytes));
  }
  return table;
}

AngleTable rs16_angles(const std::uint8_t* packet) {
  constexpr std::size_t kLasers = 16;
  AngleTable table;
  for (std::size_t i = 0; i < kLasers; ++i) {
    const std::uint8_t* at = packet + kRs16Elevations + i * kAngleBytes;
    const double magnitude_deg = 1e-4 * (static_cast<double>(at[0]) * 65'536.0 + be16(at + 1));
    table.elevation_deg.push_back(i < kLasers / 2 ? -magnitude_deg : magnitude_deg);
    table.azimuth_deg.push_back(0.0);
  }
  return table;
}

}  // namespace

DeviceInformation read_device_information_of(const ModelTraits& traits,
                                             std::span<const std::uint8_t> payload) {
  DeviceInformation information;
  information.dual = payload[kReturnModeOffset] == 0;
  if (traits.angle_form == AngleForm::kHelios) {
    information.angles = helios_angles(payload.data(), static_cast<std::size_t>(traits.lasers));
    information.sync = payload[kSyncStateOffset] != 0 ? LidarSync::kLocked : LidarSync::kFree;
  } else {
    information.angles = rs16_angles(payload.data());
  }
  return information;
}

}  // namespace isobar::robosense

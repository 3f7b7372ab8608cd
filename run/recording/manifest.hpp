// SPDX-License-Identifier: BSD-3-Clause
// recording.toml: the files of a recording folder and the mounts of its sensors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.hpp"
#include "run/recording/cloud_file.hpp"

namespace isobar::recording {

inline constexpr const char* kManifestFile = "recording.toml";
inline constexpr const char* kSegmentsFile = "segments.csv";

struct LidarEntry {
  std::string model = "VLP-16";
  std::string file = "lidar.pcap";
  std::uint16_t port = 2368;    ///< UDP destination port of the data packets
  std::uint16_t info_port = 0;  ///< of its other packets: IMU, position, device information; 0: not read
  std::string sender;           ///< IPv4 address of the lidar; empty: the first sender in the file
  /// The sensor's own calibration (Ouster's metadata, angles of Hesai and RoboSense); empty: none. A relative path
  /// starts at the recording's folder.
  std::string calibration_file;
  Mount mount;

  /// The file holds clouds instead of packets (cloud_file.hpp): ports, sender and calibration say nothing.
  [[nodiscard]] bool holds_clouds() const { return model == kCloudModel; }
};

/// A sensor with a CSV file. A barometer has no rotation; wheels, base station and reference have no mount.
struct SensorEntry {
  std::string file;
  Mount mount;
  bool robot_clock = false;  ///< base station: its stamps were converted to the robot's clock already
};

struct Manifest {
  std::string description;
  std::optional<LidarEntry> lidar;
  std::optional<SensorEntry> imu;
  std::optional<SensorEntry> barometer;
  std::optional<SensorEntry> base_barometer;
  std::optional<SensorEntry> wheel;
  std::optional<SensorEntry> reference;

  /// All sensors with the file names of docs/files-and-formats.md, mounts at the origin.
  static Manifest with_all_sensors();
};

/// Reads `folder`/recording.toml.
/// @param warnings receives "file:line: key: unknown, ignored" for keys and sections of other tools
/// @throws DataError "file:line: key: rule" when the file is missing or breaks the format
Manifest read_manifest(const std::filesystem::path& folder, std::vector<std::string>& warnings);

/// Parses the text of a recording.toml.
/// @param file name in errors
/// @throws DataError "file:line: key: rule" when the text breaks the format
Manifest parse_manifest(std::string_view content, const std::string& file,
                        std::vector<std::string>& warnings);

/// Text of a recording.toml; parsing it gives an equal manifest.
std::string manifest_text(const Manifest& manifest);

/// Writes `folder`/recording.toml; reading it gives an equal manifest.
/// @throws DataError when the file cannot be written
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

}  // namespace isobar::recording

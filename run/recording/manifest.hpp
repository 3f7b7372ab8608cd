// SPDX-License-Identifier: BSD-3-Clause
// recording.toml: what a recording folder holds and where each sensor sits on the robot.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.hpp"

namespace isobar::recording {

inline constexpr const char* kManifestFile = "recording.toml";
inline constexpr const char* kSegmentsFile = "segments.csv";

struct LidarEntry {
  std::string model = "VLP-16";
  std::string file = "lidar.pcap";
  std::uint16_t port = 2368;  ///< UDP destination port of the data packets
  Mount mount;
};

/// A sensor with a CSV file. A barometer has no rotation; wheels, base station and reference have no mount.
struct SensorEntry {
  std::string file;
  Mount mount;
};

struct Manifest {
  std::string description;
  std::optional<LidarEntry> lidar;
  std::optional<SensorEntry> imu;
  std::optional<SensorEntry> barometer;
  std::optional<SensorEntry> base_barometer;
  std::optional<SensorEntry> wheel;
  std::optional<SensorEntry> reference;

  /// All sensors with the file names of recording-format.md, mounts at the origin.
  static Manifest with_all_sensors();
};

/// Reads `folder`/recording.toml. Throws DataError "file:line: key: rule". Unknown keys and sections come
/// from other tools and are no error: they are added to `warnings` as "file:line: key: unknown, ignored".
Manifest read_manifest(const std::filesystem::path& folder, std::vector<std::string>& warnings);

/// The same from the text of a file; `file` is its name in errors.
Manifest parse_manifest(std::string_view content, const std::string& file,
                        std::vector<std::string>& warnings);

/// Writes `folder`/recording.toml; reading it back gives an equal manifest. Throws DataError.
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

}  // namespace isobar::recording

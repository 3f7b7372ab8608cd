// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/metadata.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

#include "core/errors.hpp"
#include "drivers/ouster/json_fields.hpp"

namespace isobar::ouster {
namespace {

constexpr std::size_t kMostFileBytes = 1U << 20U;
constexpr JsonFields::Sections kSensor{"sensor_info"};
constexpr JsonFields::Sections kBeams{"beam_intrinsics"};
constexpr JsonFields::Sections kFormat{"lidar_data_format", "data_format"};
constexpr JsonFields::Sections kConfig{"config_params"};
constexpr JsonFields::Sections kLidar{"lidar_intrinsics"};
constexpr JsonFields::Sections kImu{"imu_intrinsics"};
constexpr JsonFields::Range kBeamOriginMm{-500.0, 500.0};

/// Row-major 4 x 4, lengths in mm.
Eigen::Matrix4d read_transform(const JsonFields& fields, JsonFields::Sections sections, const char* key) {
  const std::vector<double> values = fields.numbers(sections, key, {-1e4, 1e4});
  if (values.size() != 16) fields.fail(sections, key, "must hold 16 numbers, row by row");
  Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const bool is_rotation = (R * R.transpose()).isIdentity(1e-3) && R.determinant() > 0.0 &&
                           T.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1));
  if (!is_rotation) fields.fail(sections, key, "must be a rotation and a translation");
  return T;
}

/// "1024x10": columns a turn, turns a second.
void read_mode(const JsonFields& fields, Metadata& metadata) {
  const std::string mode = fields.text(kConfig, "lidar_mode");
  const char* end = mode.data() + mode.size();
  int columns = 0;
  int rate = 0;
  const auto first = std::from_chars(mode.data(), end, columns);
  const bool has_x = first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x';
  const bool has_rate = has_x && std::from_chars(first.ptr + 1, end, rate).ec == std::errc{};
  if (!has_rate || columns < 1 || columns > kMostColumnsPerTurn || rate < 1 || rate > 40) {
    fields.fail(kConfig, "lidar_mode", "must be like \"1024x10\", but is \"" + mode + "\"");
  }
  metadata.turn_hz = rate;
  metadata.columns_per_turn = columns;
}

void read_profile(const JsonFields& fields, Metadata& metadata) {
  JsonFields::Sections sections = fields.has(kFormat, "udp_profile_lidar") ? kFormat : kConfig;
  if (fields.has(sections, "udp_profile_lidar")) {
    const std::string name = fields.text(sections, "udp_profile_lidar");
    const auto at = std::find_if(kProfiles.begin(), kProfiles.end(),
                                 [&name](const Profile& profile) { return profile.name == name; });
    if (at == kProfiles.end()) {
      fields.fail(sections, "udp_profile_lidar",
                  "\"" + name + "\" is not decoded; set the sensor to one of " + profile_names());
    }
    metadata.profile = &*at;
  }
  metadata.has_safety_header = metadata.profile->has_safety_header;
  if (fields.has(kFormat, "header_type")) {
    metadata.has_safety_header = fields.text(kFormat, "header_type") == "FUSA";
  }
  sections = fields.has(kFormat, "udp_profile_imu") ? kFormat : kConfig;
  if (fields.has(sections, "udp_profile_imu") &&
      fields.text(sections, "udp_profile_imu") == "ACCEL32_GYRO32_NMEA") {
    metadata.imu_profile = ImuProfile::kAccel32Gyro32Nmea;
  }
}

void read_beams(const JsonFields& fields, Metadata& metadata) {
  metadata.altitude_deg = fields.numbers(kBeams, "beam_altitude_angles", {-90.0, 90.0});
  metadata.azimuth_deg = fields.numbers(kBeams, "beam_azimuth_angles", {-180.0, 180.0});
  metadata.pixels = static_cast<int>(std::min<std::size_t>(metadata.altitude_deg.size(), kMostPixels + 1));
  const std::string rule = "must hold one angle a beam, " + std::to_string(kMostPixels) + " at most";
  if (metadata.pixels < 1 || metadata.pixels > kMostPixels) fields.fail(kBeams, "beam_altitude_angles", rule);
  if (metadata.azimuth_deg.size() != metadata.altitude_deg.size()) {
    fields.fail(kBeams, "beam_azimuth_angles", "must hold as many angles as beam_altitude_angles");
  }
  if (fields.has(kBeams, "beam_to_lidar_transform")) {
    const Eigen::Matrix4d T = read_transform(fields, kBeams, "beam_to_lidar_transform");
    metadata.beam_origin_x_mm = T(0, 3);
    metadata.beam_origin_z_mm = T(2, 3);
  } else {
    metadata.beam_origin_x_mm = fields.number(kBeams, "lidar_origin_to_beam_origin_mm", kBeamOriginMm);
  }
  metadata.T_sensor_lidar = read_transform(fields, kLidar, "lidar_to_sensor_transform");
  if (fields.has(kImu, "imu_to_sensor_transform")) {
    metadata.R_sensor_imu = read_transform(fields, kImu, "imu_to_sensor_transform").topLeftCorner<3, 3>();
  }
}

/// Firmware 1.x has no data format: 16 columns a packet, of all beams.
void read_format(const JsonFields& fields, Metadata& metadata) {
  metadata.columns_per_packet = 16;
  if (fields.has(kFormat, "columns_per_packet")) {
    metadata.columns_per_packet = fields.integer(kFormat, "columns_per_packet", {1.0, PacketColumns::kMost});
  }
  if (fields.has(kFormat, "columns_per_frame")) {
    const int columns = fields.integer(kFormat, "columns_per_frame", {1.0, kMostColumnsPerTurn});
    if (columns != metadata.columns_per_turn) {
      fields.fail(kFormat, "columns_per_frame",
                  "contradicts lidar_mode, " + std::to_string(metadata.columns_per_turn) + " columns a turn");
    }
  }
  if (fields.has(kFormat, "pixels_per_column") &&
      fields.integer(kFormat, "pixels_per_column", {1.0, kMostPixels}) != metadata.pixels) {
    fields.fail(
        kFormat, "pixels_per_column",
        "contradicts beam_altitude_angles, which holds " + std::to_string(metadata.pixels) + " angles");
  }
  const PacketLayout layout(*metadata.profile, metadata.pixels, metadata.columns_per_packet, false);
  if (layout.packet_bytes() > 65'507) {
    fields.fail(kFormat, "columns_per_packet",
                "makes packets that are longer than a UDP payload, 65507 bytes");
  }
}

TimestampMode read_timestamp_mode(const JsonFields& fields) {
  if (!fields.has(kConfig, "timestamp_mode")) return TimestampMode::kUnknown;
  const std::string mode = fields.text(kConfig, "timestamp_mode");
  if (mode == "TIME_FROM_INTERNAL_OSC") return TimestampMode::kInternal;
  if (mode == "TIME_FROM_SYNC_PULSE_IN") return TimestampMode::kSyncPulse;
  return mode == "TIME_FROM_PTP_1588" ? TimestampMode::kPtp : TimestampMode::kUnknown;
}

/// "OS-1-128" is an OS1.
void check_model(const JsonFields& fields, const std::string& line, std::string_view model) {
  std::string name = line.substr(0, line.find('-', 3));
  std::erase(name, '-');
  if (name == model) return;
  fields.fail(
      kSensor, "prod_line",
      "\"" + line + "\", but lidar.model = \"" + std::string(model) + "\": another sensor's metadata");
}

}  // namespace

Metadata parse_metadata(std::string_view json, const std::string& file, std::string_view model) {
  const JsonFields fields(json, file);
  Metadata metadata;
  metadata.file = file;
  metadata.product_line = fields.text(kSensor, "prod_line");
  check_model(fields, metadata.product_line, model);
  metadata.serial = fields.identity(kSensor, "prod_sn");
  metadata.init_id = static_cast<std::uint32_t>(fields.identity(kSensor, "initialization_id") & 0xFF'FFFFU);
  read_mode(fields, metadata);
  read_profile(fields, metadata);
  read_beams(fields, metadata);
  read_format(fields, metadata);
  metadata.timestamp_mode = read_timestamp_mode(fields);
  return metadata;
}

Metadata read_metadata(const std::filesystem::path& file, std::string_view model) {
  std::ifstream in(file, std::ios::binary);
  std::error_code error;
  if (!in || std::filesystem::is_directory(file, error)) {
    throw ConfigError("lidar.calibration_file: " + file.string() + ": cannot be read");
  }
  std::string text;
  text.resize(kMostFileBytes + 1);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMostFileBytes) {
    throw ConfigError("lidar.calibration_file: " + file.string() +
                      ": is longer than 1 MiB: no sensor's metadata");
  }
  return parse_metadata(text, file.string(), model);
}

}  // namespace isobar::ouster

// SPDX-License-Identifier: BSD-3-Clause
// The text of a recording.toml.
#include <fstream>

#include "core/errors.hpp"
#include "core/toml_text.hpp"
#include "run/recording/manifest.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

std::string triple_text(const Eigen::Vector3d& v) {
  return "[" + text::number_text(v.x()) + ", " + text::number_text(v.y()) + ", " + text::number_text(v.z()) +
         "]";
}

std::string calibration_text(const LidarEntry& lidar) {
  return lidar.calibration_file.empty() ? "" : "\ncalibration_file = " + quoted_toml(lidar.calibration_file);
}

std::string info_port_text(const LidarEntry& lidar) {
  return lidar.info_port == 0 ? "" : "\ninfo_port = " + std::to_string(lidar.info_port);
}

std::string sender_text(const LidarEntry& lidar) {
  return lidar.sender.empty() ? std::string() : "\nsender  = " + quoted_toml(lidar.sender);
}

std::string packets_text(const LidarEntry& lidar) {
  return "\nport    = " + std::to_string(lidar.port) + info_port_text(lidar) + sender_text(lidar) +
         calibration_text(lidar);
}

std::string sensor_text(const char* name, const std::optional<SensorEntry>& sensor, bool position,
                        bool rotation) {
  if (!sensor) {
    return {};
  }
  std::string text = std::string("\n[") + name + "]\nfile    = " + quoted_toml(sensor->file) + "\n";
  if (position) {
    text += "xyz_m   = " + triple_text(sensor->mount.xyz_m) + "\n";
  }
  if (rotation) {
    text += "rpy_deg = " + triple_text(sensor->mount.rpy_deg) + "\n";
  }
  if (sensor->robot_clock) {
    text += "clock   = \"robot\"\n";
  }
  return text;
}

}  // namespace

std::string manifest_text(const Manifest& manifest) {
  std::string out = "version = 1\ndescription = " + quoted_toml(manifest.description) + "\n";
  if (manifest.lidar) {
    out += "\n[lidar]\nmodel   = " + quoted_toml(manifest.lidar->model) +
           "\nfile    = " + quoted_toml(manifest.lidar->file) +
           (manifest.lidar->holds_clouds() ? std::string() : packets_text(*manifest.lidar)) +
           "\nxyz_m   = " + triple_text(manifest.lidar->mount.xyz_m) +
           "\nrpy_deg = " + triple_text(manifest.lidar->mount.rpy_deg) + "\n";
  }
  out += sensor_text("imu", manifest.imu, true, true);
  out += sensor_text("barometer", manifest.barometer, true, false);
  out += sensor_text("base_barometer", manifest.base_barometer, false, false);
  out += sensor_text("wheel", manifest.wheel, false, false);
  out += sensor_text("reference", manifest.reference, false, false);
  return out;
}

void write_manifest(const std::filesystem::path& folder, const Manifest& manifest) {
  const std::filesystem::path file = folder / kManifestFile;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << manifest_text(manifest);
  out.close();
  if (!out) {
    throw DataError(file.string() + ": cannot be written");
  }
}

}  // namespace isobar::recording

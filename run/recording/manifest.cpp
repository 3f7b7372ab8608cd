// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/manifest.hpp"

#include <arpa/inet.h>
#include <toml++/toml.h>

#include <cmath>
#include <fstream>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "core/toml_text.hpp"
#include "run/text/bounded_toml.hpp"
#include "run/text/number_text.hpp"
#include "run/text/small_file.hpp"

namespace isobar::recording {
namespace {

/// Largest distance of a sensor from base_link, by axis; a larger number is a mistake of units.
constexpr double kMaxLeverM = 100.0;
constexpr double kMaxAngleDeg = 360.0;
/// Most warnings about one file: a foreign file may hold thousands of unknown keys.
constexpr std::size_t kMostWarnings = 50;

/// Access to the nodes of a recording.toml; errors and warnings name file, line and key.
class ManifestText {
 public:
  ManifestText(std::string file, std::vector<std::string>& warnings)
      : file_(std::move(file)), warnings_(warnings) {}

  [[noreturn]] void fail(const toml::node& node, const std::string& key, const std::string& rule) const {
    throw DataError(place(node) + printable(key) + ": " + rule);
  }

  void warn(const toml::node& node, const std::string& key) {
    if (warnings_.size() < kMostWarnings) {
      warnings_.push_back(place(node) + printable(key) + ": unknown, ignored");
    }
  }

  /// A section, or nullptr where it is absent.
  const toml::table* section(const toml::table& root, const std::string& name) const {
    const toml::node* node = root.get(name);
    if (node != nullptr && !node->is_table()) {
      fail(*node, name, "must be a section, [" + name + "]");
    }
    return node == nullptr ? nullptr : node->as_table();
  }

  std::string file_name(const toml::table& table, const std::string& section_name) const {
    const toml::node* node = table.get("file");
    if (node == nullptr) {
      fail(table, section_name + ".file", "missing");
    }
    const auto text = node->value<std::string>();
    if (!text || text->empty()) {
      fail(*node, section_name + ".file", "must be the name of a file");
    }
    const std::filesystem::path path(*text);
    bool leaves_folder = path.is_absolute();
    for (const auto& part : path) {
      leaves_folder = leaves_folder || part == "..";
    }
    if (leaves_folder) {
      fail(*node, section_name + ".file", "must lie inside the recording folder");
    }
    return *text;
  }

  Eigen::Vector3d triple(const toml::table& table, const std::string& section_name, const std::string& key,
                         double limit) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      return Eigen::Vector3d::Zero();
    }
    const std::string rule =
        "must be three numbers within -" + text::number_text(limit) + " … " + text::number_text(limit);
    const std::string name = section_name + "." + key;
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != 3) {
      fail(*node, name, rule);
    }
    Eigen::Vector3d result;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = (*array)[i].value<double>();
      if (!value || !(std::abs(*value) <= limit)) {
        fail(*node, name, rule);
      }
      result[static_cast<Eigen::Index>(i)] = *value;
    }
    return result;
  }

  Mount mount(const toml::table& table, const std::string& section_name) const {
    return {triple(table, section_name, "xyz_m", kMaxLeverM),
            triple(table, section_name, "rpy_deg", kMaxAngleDeg)};
  }

  void warn_unknown_keys(const toml::table& table, const std::string& section_name,
                         std::initializer_list<std::string_view> known) {
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
        warn(node, section_name + std::string(key.str()));
      }
    }
  }

 private:
  [[nodiscard]] std::string place(const toml::node& node) const {
    return file_ + ":" + std::to_string(node.source().begin.line) + ": ";
  }

  std::string file_;
  std::vector<std::string>& warnings_;
};

/// @param least smallest number that is accepted
std::uint16_t read_port(const toml::table& table, const char* key, std::uint16_t missing, int least,
                        ManifestText& text) {
  const toml::node* port = table.get(key);
  if (port == nullptr) return missing;
  // value_exact: value() would cast a float to an integer, undefined behaviour for 1e72.
  const auto value = port->value_exact<std::int64_t>();
  if (!value || *value < least || *value > 65'535) {
    text.fail(*port, std::string("lidar.") + key,
              "must be a whole number within " + std::to_string(least) + " … 65535");
  }
  return static_cast<std::uint16_t>(*value);
}

std::optional<LidarEntry> read_lidar(const toml::table& root, ManifestText& text) {
  const toml::table* table = text.section(root, "lidar");
  if (table == nullptr) {
    return std::nullopt;
  }
  text.warn_unknown_keys(
      *table, "lidar.",
      {"model", "file", "port", "info_port", "sender", "calibration_file", "xyz_m", "rpy_deg"});
  LidarEntry lidar;
  const toml::node* model = table->get("model");
  if (model == nullptr || !model->is_string() || model->value<std::string>()->empty()) {
    text.fail(model == nullptr ? *table : *model, "lidar.model", "must name the sensor, such as \"VLP-16\"");
  }
  lidar.model = *model->value<std::string>();
  lidar.file = text.file_name(*table, "lidar");
  lidar.port = read_port(*table, "port", lidar.port, 1, text);
  lidar.info_port = read_port(*table, "info_port", lidar.info_port, 0, text);
  if (const toml::node* sender = table->get("sender"); sender != nullptr) {
    const auto value = sender->value<std::string>();
    in_addr address{};
    if (!value || inet_pton(AF_INET, value->c_str(), &address) != 1) {
      text.fail(*sender, "lidar.sender", "must be an IPv4 address such as \"192.168.1.201\"");
    }
    lidar.sender = *value;
  }
  if (const toml::node* calibration = table->get("calibration_file"); calibration != nullptr) {
    if (!calibration->is_string()) text.fail(*calibration, "lidar.calibration_file", "must name a file");
    lidar.calibration_file = *calibration->value<std::string>();
  }
  lidar.mount = text.mount(*table, "lidar");
  return lidar;
}

std::optional<SensorEntry> read_sensor(const toml::table& root, const std::string& name, ManifestText& text) {
  const toml::table* table = text.section(root, name);
  if (table == nullptr) {
    return std::nullopt;
  }
  text.warn_unknown_keys(*table, name + ".", {"file", "xyz_m", "rpy_deg", "clock"});
  const toml::node* clock = table->get("clock");
  if (clock != nullptr && clock->value<std::string>() != "robot") {
    text.fail(*clock, name + ".clock", "must be \"robot\", or left out: the sender's own clock");
  }
  return SensorEntry{text.file_name(*table, name), text.mount(*table, name), clock != nullptr};
}

std::string read_text(const std::filesystem::path& folder, const std::filesystem::path& file) {
  if (!std::filesystem::is_directory(folder)) {
    throw DataError(folder.string() +
                    (std::filesystem::exists(folder) ? ": is no folder; a recording is a folder with "
                                                     : ": no such folder; a recording is a folder with ") +
                    kManifestFile);
  }
  if (!std::filesystem::exists(file)) {
    throw DataError(folder.string() + ": holds no " + kManifestFile + ", so it is no recording");
  }
  text::SmallFile read = text::read_small_file(file, text::kMostManifestBytes);
  if (!read.refusal.empty()) throw DataError(file.string() + ": " + read.refusal);
  if (read.content.empty()) throw DataError(file.string() + ": version: must be 1; the file is empty");
  return std::move(read.content);
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  try {
    return text::parse_bounded_toml(text, file);
  } catch (const text::TomlError& error) {
    throw DataError(file + ":" + std::to_string(error.line()) + ": " + error.what());
  }
}

}  // namespace

Manifest Manifest::with_all_sensors() {
  Manifest manifest;
  manifest.lidar = LidarEntry{};
  manifest.imu = SensorEntry{"imu.csv", {}};
  manifest.barometer = SensorEntry{"barometer.csv", {}};
  manifest.base_barometer = SensorEntry{"base_barometer.csv", {}};
  manifest.wheel = SensorEntry{"wheel.csv", {}};
  manifest.reference = SensorEntry{"reference.tum", {}};
  return manifest;
}

Manifest read_manifest(const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  const std::filesystem::path file = folder / kManifestFile;
  return parse_manifest(read_text(folder, file), file.string(), warnings);
}

Manifest parse_manifest(std::string_view content, const std::string& file,
                        std::vector<std::string>& warnings) {
  const toml::table root = parse_toml(content, file);
  ManifestText text(file, warnings);
  text.warn_unknown_keys(
      root, "",
      {"version", "description", "lidar", "imu", "barometer", "base_barometer", "wheel", "reference"});
  const toml::node* version = root.get("version");
  if (version == nullptr || version->value_exact<std::int64_t>() != 1) {
    text.fail(version == nullptr ? static_cast<const toml::node&>(root) : *version, "version", "must be 1");
  }
  Manifest manifest;
  if (const toml::node* description = root.get("description"); description != nullptr) {
    if (!description->is_string()) {
      text.fail(*description, "description", "must be a text");
    }
    manifest.description = *description->value<std::string>();
  }
  manifest.lidar = read_lidar(root, text);
  manifest.imu = read_sensor(root, "imu", text);
  manifest.barometer = read_sensor(root, "barometer", text);
  manifest.base_barometer = read_sensor(root, "base_barometer", text);
  manifest.wheel = read_sensor(root, "wheel", text);
  manifest.reference = read_sensor(root, "reference", text);
  return manifest;
}

}  // namespace isobar::recording

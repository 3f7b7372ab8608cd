// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar_models/lidar_models.hpp"

#include <algorithm>
#include <array>

#include "core/errors.hpp"
#include "drivers/hesai/decoder.hpp"
#include "drivers/lidar/angle_table.hpp"
#include "drivers/livox/decoder.hpp"
#include "drivers/ouster/decoder.hpp"
#include "drivers/robosense/decoder.hpp"
#include "drivers/velodyne/decoder.hpp"

namespace isobar {
namespace {

template <const velodyne::ModelTraits& kTraits>
std::unique_ptr<LidarDecoder> make_velodyne(const LidarConfig& config) {
  return std::make_unique<velodyne::Decoder>(kTraits, config.limits);
}

/// The angles of the sensor's file; none where no file is named.
AngleTable angles_of(const LidarConfig& config, int lasers) {
  if (config.calibration_file.empty()) return {};
  return read_angle_file(config.calibration_file, static_cast<std::size_t>(lasers));
}

template <const hesai::ModelTraits& kTraits>
std::unique_ptr<LidarDecoder> make_hesai(const LidarConfig& config) {
  return std::make_unique<hesai::Decoder>(kTraits, config.limits, angles_of(config, kTraits.lasers));
}

template <const robosense::ModelTraits& kTraits>
std::unique_ptr<LidarDecoder> make_robosense(const LidarConfig& config) {
  return std::make_unique<robosense::Decoder>(kTraits, config.limits, angles_of(config, kTraits.lasers));
}

/// OS0, OS1 and OS2: the metadata says the rest.
std::unique_ptr<LidarDecoder> make_ouster(const LidarConfig& config) {
  const std::string_view name = find_lidar_model(config.model)->name;
  return std::make_unique<ouster::Decoder>(name, ouster::read_metadata(config.calibration_file, name),
                                           config.limits);
}

std::unique_ptr<LidarDecoder> make_mid360(const LidarConfig& config) {
  return std::make_unique<livox::Decoder>(config.limits);
}

constexpr std::array kModels{
    LidarModel{"VLP-16", "Velodyne", 2368, 8308, false, false, &make_velodyne<velodyne::kVlp16>},
    LidarModel{"VLP-16 Hi-Res", "Velodyne", 2368, 8308, false, false, &make_velodyne<velodyne::kVlp16HiRes>},
    LidarModel{"VLP-32C", "Velodyne", 2368, 8308, false, false, &make_velodyne<velodyne::kVlp32c>},
    LidarModel{"HDL-32E", "Velodyne", 2368, 8308, false, false, &make_velodyne<velodyne::kHdl32e>},
    LidarModel{"XT16", "Hesai", 2368, 10110, false, false, &make_hesai<hesai::kXt16>},
    LidarModel{"XT32", "Hesai", 2368, 10110, false, false, &make_hesai<hesai::kXt32>},
    LidarModel{"RS-LiDAR-16", "RoboSense", 6699, 7788, false, false, &make_robosense<robosense::kRs16>},
    LidarModel{"Helios-16P", "RoboSense", 6699, 7788, false, false, &make_robosense<robosense::kHelios16p>},
    LidarModel{"OS0", "Ouster", ouster::kDataPort, ouster::kImuPort, true, true, &make_ouster},
    LidarModel{"OS1", "Ouster", ouster::kDataPort, ouster::kImuPort, true, true, &make_ouster},
    LidarModel{"OS2", "Ouster", ouster::kDataPort, ouster::kImuPort, true, true, &make_ouster},
    LidarModel{"Mid-360", "Livox", livox::kDataPort, livox::kImuPort, true, false, &make_mid360},
};

}  // namespace

std::span<const LidarModel> lidar_models() { return kModels; }

const LidarModel* find_lidar_model(std::string_view name) {
  const auto at = std::find_if(kModels.begin(), kModels.end(),
                               [name](const LidarModel& model) { return model.name == name; });
  return at == kModels.end() ? nullptr : &*at;
}

std::vector<std::string> lidar_model_names() {
  std::vector<std::string> names;
  names.reserve(kModels.size());
  for (const LidarModel& model : kModels) names.emplace_back(model.name);
  return names;
}

std::string lidar_model_list() {
  std::string text;
  for (const LidarModel& model : kModels) {
    const bool is_last = &model == &kModels.back();
    text += (text.empty() ? "" : is_last ? " and " : ", ") + std::string(model.name);
  }
  return text;
}

std::unique_ptr<LidarDecoder> make_lidar_decoder(const LidarConfig& config) {
  const LidarModel* model = find_lidar_model(config.model);
  if (model == nullptr) {
    throw ConfigError("lidar.model: \"" + config.model + "\" has no driver; there are " + lidar_model_list());
  }
  if (model->needs_calibration && config.calibration_file.empty()) {
    throw ConfigError("lidar.calibration_file: must name the sensor's metadata (JSON): the packets of an " +
                      config.model + " cannot be decoded without it");
  }
  return model->make(config);
}

}  // namespace isobar

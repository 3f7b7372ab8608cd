// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "config/setting_rules.hpp"
#include "config/value_text.hpp"
#include "core/errors.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "ipc/keys/limits.hpp"

namespace isobar {
namespace {

/// Collects the broken rules, each with the place of its key.
class Requirements {
 public:
  Requirements(const PlaceOfKey& place_of, Problems& problems) : place_of_(place_of), problems_(problems) {}

  void require(bool holds, const std::string& key, const std::string& rule) const {
    if (!holds) problems_.add(place_of_(key) + ": " + key + ": " + rule);
  }

 private:
  const PlaceOfKey& place_of_;
  Problems& problems_;
};

/// Error text for DPS310 rates whose measurements take 1 s or more in a second.
std::string busy_text(const dps310::Settings& settings) {
  const auto product = [](int rate_hz, int oversampling) {
    return std::to_string(rate_hz) + " x " +
           number_text(std::round(dps310::measurement_time_s(oversampling) * 1e4) / 10.0) + " ms";
  };
  return "pressure " + product(settings.pressure_rate_hz, settings.pressure_oversampling) +
         " and temperature " + product(settings.temperature_rate_hz, settings.temperature_oversampling) +
         " are " + number_text(std::round(dps310::busy_time_s(settings) * 1e3) / 1e3) +
         " s of measuring in a second, must be below 1; lower a rate or an oversampling";
}

/// The same for sensors of one rate.
std::string busy_text(int rate_hz, double busy_s) {
  return std::to_string(rate_hz) + " measurements of " +
         number_text(std::round(busy_s / rate_hz * 1e4) / 10.0) + " ms are " +
         number_text(std::round(busy_s * 1e3) / 1e3) +
         " s of measuring in a second, must be below 1; lower the rate or an oversampling";
}

/// Settings of the IMU's own driver, and of a barometer within it.
void check_imu(const Config& config, const Requirements& rules) {
  const ImuSettings& imu = config.imu;
  const char* broken = imu.source == ImuSource::kVn100   ? vn100::broken_rule(imu.vn100)
                       : imu.source == ImuSource::kXsens ? xsens::broken_rule(imu.xsens)
                                                         : nullptr;
  const char* key = imu.source == ImuSource::kVn100 ? "imu.vn100.rate_hz" : "imu.xsens.rate_hz";
  rules.require(broken == nullptr, key, broken == nullptr ? "" : broken);
  const LidarModel* lidar = find_lidar_model(config.lidar.model);
  const bool has_packets = config.lidar.source == LidarSource::kDriver;
  rules.require(imu.source != ImuSource::kLidar || (has_packets && lidar != nullptr && lidar->has_imu),
                "imu.source",
                "must not be \"lidar\": a " + config.lidar.model + " has no IMU that its packets hold");
  const bool has_barometer =
      config.role == Role::kRobot && (imu.source == ImuSource::kVn100 || imu.source == ImuSource::kXsens);
  rules.require(config.barometer.source != BarometerSource::kImu || has_barometer, "barometer.source",
                "must not be \"imu\" without imu.source \"vn100\" or \"xsens\", on a robot");
}

/// Lines of the encoders, where these are the wheels' source.
void check_wheels(const Config& config, const Requirements& rules) {
  if (config.wheel.source != WheelSource::kEncoder) return;
  const encoder::BrokenRule broken = encoder::broken_rule(config.wheel.encoder);
  rules.require(broken.rule == nullptr, std::string("wheel.encoder.") + broken.name,
                broken.rule == nullptr ? "" : broken.rule);
}

void check_sensors(const Config& config, const Requirements& rules) {
  check_imu(config, rules);
  check_wheels(config, rules);
  rules.require(config.lidar.min_range_m < config.lidar.max_range_m, "lidar.min_range_m",
                "must be below lidar.max_range_m");
  rules.require(config.lidar.port != config.input.port || config.role == Role::kBaseStation, "input.port",
                "must differ from lidar.port");
  const BarometerSettings& barometer = config.barometer;
  rules.require(barometer.source != BarometerSource::kDds || config.role == Role::kRobot, "barometer.source",
                "must not be \"dds\" on a base station, which publishes its pressure there");
  rules.require(barometer.present() || config.role == Role::kRobot, "barometer.source",
                "must not be \"none\": a base station measures air pressure");
  if (barometer.source == BarometerSource::kDps310) {
    rules.require(dps310::busy_time_s(barometer.dps310) < 1.0, "barometer.dps310.pressure_rate_hz",
                  busy_text(barometer.dps310));
  }
  const auto require_time = [&](BarometerSource source, const char* key, int rate_hz, double busy_s) {
    if (barometer.source == source) rules.require(busy_s < 1.0, key, busy_text(rate_hz, busy_s));
  };
  require_time(BarometerSource::kBmp581, "barometer.bmp581.rate_hz", barometer.bmp581.rate_hz,
               bmp581::busy_time_s(barometer.bmp581));
  require_time(BarometerSource::kBmp390, "barometer.bmp390.rate_hz", barometer.bmp390.rate_hz,
               bmp390::busy_time_s(barometer.bmp390));
  require_time(BarometerSource::kMs5611, "barometer.ms5611.rate_hz", barometer.ms5611.rate_hz,
               ms5611::busy_time_s(barometer.ms5611));
  if (barometer.source == BarometerSource::kSetra278) {
    const char* broken = setra278::broken_rule(barometer.setra278.span);
    rules.require(broken == nullptr, "barometer.setra278", broken == nullptr ? "" : broken);
  }
}

using NamedText = std::pair<const char*, const std::string*>;

/// Each text must differ from all others; the key of the later one is reported.
template <std::size_t N>
void require_different(const std::array<NamedText, N>& texts, const Requirements& rules) {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t before = 0; before < i; ++before) {
      rules.require(*texts[i].second != *texts[before].second, texts[i].first,
                    std::string("must differ from ") + texts[before].first);
    }
  }
}

void check_topic_names(const dds::TopicNames& names, const Requirements& rules) {
  require_different(std::array<NamedText, 16>{{
                        {"dds.topics.odom", &names.odom},
                        {"dds.topics.pose", &names.pose},
                        {"dds.topics.altitude", &names.altitude},
                        {"dds.topics.tf", &names.tf},
                        {"dds.topics.tf_static", &names.tf_static},
                        {"dds.topics.registered_scan", &names.registered_scan},
                        {"dds.topics.map_cloud", &names.map_cloud},
                        {"dds.topics.map", &names.map},
                        {"dds.topics.floor", &names.floor},
                        {"dds.topics.floor_name", &names.floor_name},
                        {"dds.topics.diagnostics", &names.diagnostics},
                        {"dds.topics.points", &names.points},
                        {"dds.topics.pressure", &names.pressure},
                        {"dds.topics.imu", &names.imu},
                        {"dds.topics.wheel", &names.wheel},
                        {"dds.topics.initial_pose", &names.initial_pose},
                    }},
                    rules);
  rules.require(names.base_temperature != names.base_pressure, "dds.topics.base_temperature",
                "must differ from dds.topics.base_pressure");
}

void check_estimator(const Config& config, const Requirements& rules) {
  const AltimeterConfig& altimeter = config.prior.altimeter;
  rules.require(config.registration.min_range_m < config.registration.max_range_m, "registration.min_range_m",
                "must be below registration.max_range_m");
  rules.require(config.registration.last_distance_m <= config.registration.first_distance_m,
                "registration.last_distance_m", "must not be above registration.first_distance_m");
  rules.require(altimeter.min_pressure_pa < altimeter.max_pressure_pa, "altimeter.min_pressure_pa",
                "must be below altimeter.max_pressure_pa");
  rules.require(altimeter.noise_floor_pa <= altimeter.initial_noise_pa &&
                    altimeter.initial_noise_pa <= altimeter.noise_ceiling_pa,
                "altimeter.initial_noise_pa",
                "must lie between altimeter.noise_floor_pa and altimeter.noise_ceiling_pa");
}

/// tf2 joins frames by their names: two frames of one name are a loop.
void check_frames(const dds::DdsConfig& dds, const Requirements& rules) {
  require_different(std::array<NamedText, 7>{{
                        {"dds.map_frame", &dds.map_frame},
                        {"dds.odom_frame", &dds.odom_frame},
                        {"dds.base_frame", &dds.base_frame},
                        {"dds.lidar_frame", &dds.lidar_frame},
                        {"dds.imu_frame", &dds.imu_frame},
                        {"dds.barometer_frame", &dds.barometer_frame},
                        {"dds.footprint_frame", &dds.footprint_frame},  // empty: no other one is
                    }},
                    rules);
}

}  // namespace

void check_compensation(const CompensationConfig& compensation, const std::string& place) {
  const char* key = nullptr;
  if (const char* rule = broken_compensation_rule(compensation, &key); rule != nullptr) {
    throw ConfigError(place + key + ": " + rule);
  }
}

void check_together(const Config& config, const PlaceOfKey& place_of, Problems& problems) {
  const Requirements rules(place_of, problems);
  check_sensors(config, rules);
  check_estimator(config, rules);
  check_topic_names(config.dds.topics, rules);
  rules.require(config.dds.second_base_station != config.dds.base_station, "dds.second_base_station",
                "must differ from dds.base_station");
  rules.require(config.dds.keys_directory.empty() || config.dds.domain_id <= keys::kLastDomain,
                "dds.domain_id",
                "must be at most 230 with dds.keys_directory: DDS security knows no higher one");
  if (config.role == Role::kRobot) check_frames(config.dds, rules);
  problems.attempt([&] {
    check_compensation(config.prior.compensation,
                       place_of("barometer.compensation") + ": barometer.compensation.");
  });
  problems.attempt([&] {
    check_compensation(config.prior.base_compensation,
                       place_of("base_barometer.compensation") + ": base_barometer.compensation.");
  });
}

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#include "config/value_text.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "core/errors.hpp"
#include "core/toml_text.hpp"

namespace isobar {
namespace {

template <typename Number>
std::string shortest(Number value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// A TOML float, which needs a dot or an exponent.
std::string float_text(double value) {
  std::string text = shortest(value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

template <typename Number>
std::string list_text(const std::vector<Number>& values, std::string (*text_of)(Number)) {
  std::string text;
  for (const Number value : values) {
    text += (text.empty() ? "" : ", ") + text_of(value);
  }
  return "[" + text + "]";
}

struct ValueText {
  const Setting& setting;

  std::string operator()(const double* value) const { return float_text(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return quoted_toml(*value); }
  std::string operator()(const Eigen::Vector3d* v) const {
    return "[" + float_text(v->x()) + ", " + float_text(v->y()) + ", " + float_text(v->z()) + "]";
  }
  std::string operator()(const std::vector<int>* values) const { return list_text(*values, shortest<int>); }
  std::string operator()(const std::vector<double>* values) const { return list_text(*values, float_text); }
  std::string operator()(const Role* value) const {
    return quoted_toml(setting.choices.at(static_cast<std::size_t>(*value)));
  }
  std::string operator()(const Method* value) const {
    return quoted_toml(setting.choices.at(static_cast<std::size_t>(*value)));
  }
  std::string operator()(const Matcher* value) const {
    return quoted_toml(setting.choices.at(static_cast<std::size_t>(*value)));
  }
  std::string operator()(const AirTemperatureMode* value) const {
    return quoted_toml(setting.choices.at(static_cast<std::size_t>(*value)));
  }
  std::string operator()(const CompensationModel* value) const {
    return quoted_toml(setting.choices.at(static_cast<std::size_t>(*value)));
  }
  template <typename Integer>
  std::string operator()(const Integer* value) const {
    return shortest(*value);
  }
};

bool consists_of(const std::string& text, const char* also) {
  return std::all_of(text.begin(), text.end(), [also](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view(also).find(static_cast<char>(c)) != std::string_view::npos;
  });
}

/// Why a DPS310 cannot do what is asked.
std::string busy_text(const dps310::Settings& settings) {
  const auto product = [](int rate_hz, int oversampling) {
    return shortest(rate_hz) + " x " +
           shortest(std::round(dps310::measurement_time_s(oversampling) * 1e4) / 10.0) + " ms";
  };
  return "pressure " + product(settings.pressure_rate_hz, settings.pressure_oversampling) +
         " and temperature " + product(settings.temperature_rate_hz, settings.temperature_oversampling) +
         " are " + shortest(std::round(dps310::busy_time_s(settings) * 1e3) / 1e3) +
         " s of measuring in a second, must be below 1; lower a rate or an oversampling";
}

}  // namespace

std::string range_text(const Setting& setting) {
  if (!setting.choices.empty()) {
    return {};
  }
  const bool has_low = std::isfinite(setting.lowest);
  const bool has_high = std::isfinite(setting.highest);
  const std::string unit = setting.unit.empty() ? "" : " " + setting.unit;
  return has_low && has_high
             ? " within " + shortest(setting.lowest) + " … " + shortest(setting.highest) + unit
             : std::string();
}

std::string value_text(const Setting& setting) { return std::visit(ValueText{setting}, setting.target); }

const char* broken_text_rule(TextRule rule, const std::string& text) {
  switch (rule) {
    case TextRule::kAny:
      return nullptr;
    case TextRule::kIpv4: {
      in_addr address{};
      return inet_pton(AF_INET, text.c_str(), &address) == 1 ? nullptr
                                                             : "must be an IPv4 address such as \"0.0.0.0\"";
    }
    case TextRule::kNameOrEmpty:
      if (text.empty()) {
        return nullptr;
      }
      [[fallthrough]];
    case TextRule::kName: {
      const bool fits = !text.empty() && text.size() <= 100 && consists_of(text, "_/") &&
                        text.front() != '/' && text.back() != '/';
      return fits ? nullptr : "must be 1 to 100 letters, digits, '_' or '/', with no '/' at the ends";
    }
    case TextRule::kInterface:
      return text.size() <= 64 && consists_of(text, "_.-:@")
                 ? nullptr
                 : "must be the name or the address of a network interface";
  }
  return nullptr;
}

void check_compensation(const CompensationConfig& compensation, const std::string& place) {
  const char* key = nullptr;
  if (const char* rule = broken_compensation_rule(compensation, &key); rule != nullptr) {
    throw ConfigError(place + key + ": " + rule);
  }
}

void check_together(const Config& config, const std::string& file) {
  const auto require = [&file](bool holds, const char* key, const char* rule) {
    if (!holds) {
      throw ConfigError(file + ": " + key + ": " + rule);
    }
  };
  const AltimeterConfig& altimeter = config.prior.altimeter;
  require(config.lidar.min_range_m < config.lidar.max_range_m, "lidar.min_range_m",
          "must be below lidar.max_range_m");
  require(config.registration.min_range_m < config.registration.max_range_m, "registration.min_range_m",
          "must be below registration.max_range_m");
  require(altimeter.min_pressure_pa < altimeter.max_pressure_pa, "altimeter.min_pressure_pa",
          "must be below altimeter.max_pressure_pa");
  require(altimeter.noise_floor_pa <= altimeter.initial_noise_pa &&
              altimeter.initial_noise_pa <= altimeter.noise_ceiling_pa,
          "altimeter.initial_noise_pa",
          "must lie between altimeter.noise_floor_pa and altimeter.noise_ceiling_pa");
  require(config.registration.last_distance_m <= config.registration.first_distance_m,
          "registration.last_distance_m", "must not be above registration.first_distance_m");
  require(config.dds.second_base_station != config.dds.base_station, "dds.second_base_station",
          "must differ from dds.base_station");
  require(config.lidar.port != config.input.port || config.role == Role::kBaseStation, "input.port",
          "must differ from lidar.port");
  check_compensation(config.prior.compensation, file + ": barometer.compensation.");
  check_compensation(config.prior.base_compensation, file + ": base_barometer.compensation.");
  const BarometerSettings& barometer = config.barometer;
  require(barometer.source != "dps310" || dps310::busy_time_s(barometer.dps310) < 1.0,
          "barometer.dps310.pressure_rate_hz", busy_text(barometer.dps310).c_str());
  const char* span_rule = setra278::broken_rule(barometer.setra278.span);
  require(barometer.source != "setra278" || span_rule == nullptr, "barometer.setra278", span_rule);
}

}  // namespace isobar

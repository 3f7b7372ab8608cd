// SPDX-License-Identifier: BSD-3-Clause
// The table of all settings. Loading, checking, showing and the search for unknown keys all read this one
// table.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/config.hpp"

namespace isobar {

/// What a text may be.
enum class TextRule : std::uint8_t {
  kAny,
  kIpv4,  ///< dotted IPv4 address
  kName,  ///< 1 to 100 letters, digits, '_' or '/', no '/' at the ends
  kNameOrEmpty,
  kInterface,  ///< name or address of a network interface, or empty
};

/// One key of the configuration, bound to its place in a Config.
struct Setting {
  using Target = std::variant<double*, int*, std::uint16_t*, std::uint32_t*, std::size_t*, bool*,
                              std::string*, Eigen::Vector3d*, std::vector<int>*, std::vector<double>*, Role*,
                              Method*, AirTemperatureMode*, CompensationModel*, Matcher*>;

  std::string key;  ///< with its section, "registration.max_range_m"
  Target target;
  std::string unit{};                                        ///< empty: none
  double lowest = -std::numeric_limits<double>::infinity();  ///< numbers; each element of lists
  double highest = std::numeric_limits<double>::infinity();
  std::string doc{};  ///< what it is and why it has its default
  TextRule text_rule = TextRule::kAny;
  std::vector<std::string> choices{};  ///< texts: only these; numbers: only these

  [[nodiscard]] std::string section() const;  ///< "registration"; empty at the top
  [[nodiscard]] std::string name() const;     ///< "max_range_m"
};

/// The names of an enumeration's values, in their order.
const std::vector<std::string>& role_choices();
const std::vector<std::string>& method_choices();
const std::vector<std::string>& air_temperature_choices();
const std::vector<std::string>& compensation_choices();
const std::vector<std::string>& matcher_choices();

/// All settings of `config`, in the order in which they are shown.
std::vector<Setting> settings_of(Config& config);

/// Does this key mean nothing to a base station? It has no lidar, no motion and no map.
bool is_for_robots_only(std::string_view key);

/// A sentence for the head of a section.
std::string_view section_doc(std::string_view section);

// The parts of the table, by the code that the settings belong to.
void add_sensor_settings(Config& config, std::vector<Setting>& settings);
void add_compensation_settings(const std::string& section, CompensationConfig& compensation,
                               std::vector<Setting>& settings);
void add_service_settings(Config& config, std::vector<Setting>& settings);
void add_prior_settings(PriorConfig& prior, std::vector<Setting>& settings);
void add_registration_settings(RegistrationConfig& registration, std::vector<Setting>& settings);
void add_map_settings(MapConfig& map, std::vector<Setting>& settings);

}  // namespace isobar

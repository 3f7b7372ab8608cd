// SPDX-License-Identifier: BSD-3-Clause
// The settings table: one entry per key. Loading, checking, printing and the search for unknown keys read it.
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

/// Rule of a text value.
enum class TextRule : std::uint8_t {
  kAny,
  kIpv4,         ///< dotted IPv4 address
  kIpv4OrEmpty,  ///< kIpv4, or empty
  kIpv4List,     ///< up to 16 of kIpv4, separated by commas, or empty
  kName,         ///< 1 to 100 letters, digits, '_' or '/', no '/' at the ends
  kNameOrEmpty,  ///< kName, or empty
  kPrefix,       ///< up to 100 letters, digits, '_' or '/', no '/' at the front, or empty
  kInterfaces,   ///< names or addresses of network interfaces, separated by commas, or empty
  kRosName,      ///< kName whose parts do not begin with a digit and have no "__"
  kRosNameOrEmpty,
  kRosNode,  ///< kRosName without '/'
};

/// Who needs a setting.
enum class Audience : std::uint8_t {
  kBasic,   ///< everyone who sets up a robot or a base station
  kExpert,  ///< only those who tune the estimator or the service
};

/// When a changed value takes effect.
enum class Apply : std::uint8_t {
  kLive,     ///< at once, in the running program
  kStage,    ///< when the stage that uses it is built anew
  kRestart,  ///< at the next start of the program
};

/// Roles in which a setting is used.
enum class UsedBy : std::uint8_t {
  kRobot,      ///< robots only; a base station has no lidar, no motion and no map
  kEveryRole,  ///< robots and base stations
};

/// One key of the configuration, bound to its place in a Config.
struct Setting {
  using Target =
      std::variant<double*, int*, std::uint16_t*, std::uint32_t*, std::size_t*, bool*, std::string*,
                   Eigen::Vector3d*, std::vector<int>*, std::vector<double>*, Role*, Method*,
                   AirTemperatureMode*, CompensationModel*, Matcher*, LidarSource*, LidarTime*, ImuSource*,
                   BarometerSource*, WheelSource*, MapUse*, encoder::Drive*, dds::Reliability*>;

  std::string key;  ///< with its section, "registration.max_range_m"
  Target target;
  std::string unit{};                                        ///< empty: none
  double lowest = -std::numeric_limits<double>::infinity();  ///< numbers; each element of lists
  double highest = std::numeric_limits<double>::infinity();
  std::string doc{};  ///< meaning, and reason of the default
  TextRule text_rule = TextRule::kAny;
  std::vector<std::string> choices{};  ///< if not empty, the only texts or numbers allowed
  UsedBy used_by = UsedBy::kEveryRole;
  Audience audience = Audience::kExpert;
  Apply apply = Apply::kRestart;

  [[nodiscard]] std::string section() const;  ///< "registration"; empty at the top
  [[nodiscard]] std::string name() const;     ///< "max_range_m"

  /// Marks the setting as basic.
  void basic() { audience = Audience::kBasic; }
};

/// Names of an enumeration's values, in the order of the enumerators.
const std::vector<std::string>& role_choices();
const std::vector<std::string>& method_choices();
const std::vector<std::string>& air_temperature_choices();
const std::vector<std::string>& compensation_choices();
const std::vector<std::string>& matcher_choices();

/// All settings of `config`, section by section.
std::vector<Setting> settings_of(Config& config);

/// The sentence that introduces a section; empty for an unknown one.
std::string_view section_doc(std::string_view section);

// The parts of the table, by the code that the settings belong to.
void add_lidar_settings(LidarSettings& lidar, std::vector<Setting>& settings);
void add_imu_settings(ImuSettings& imu, std::vector<Setting>& settings);
void add_barometer_settings(Config& config, std::vector<Setting>& settings);
void add_wheel_settings(WheelSettings& wheel, std::vector<Setting>& settings);
void add_compensation_settings(const std::string& section, UsedBy used_by, CompensationConfig& compensation,
                               std::vector<Setting>& settings);
void add_service_settings(Config& config, std::vector<Setting>& settings);
void add_black_box_settings(BlackBoxSettings& black_box, std::vector<Setting>& settings);
void add_dds_settings(dds::DdsConfig& dds, std::vector<Setting>& settings);
void add_altimeter_settings(AltimeterConfig& altimeter, std::vector<Setting>& settings);
void add_motion_settings(PriorConfig& prior, std::vector<Setting>& settings);
void add_height_settings(HeightConfig& height, std::vector<Setting>& settings);
void add_registration_settings(RegistrationConfig& registration, std::vector<Setting>& settings);
void add_loop_settings(LoopConfig& loops, std::vector<Setting>& settings);
void add_floor_settings(FloorSettings& floors, std::vector<Setting>& settings);
void add_map_settings(MapConfig& map, MapFileSettings& files, std::vector<Setting>& settings);

}  // namespace isobar

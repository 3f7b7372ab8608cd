// SPDX-License-Identifier: BSD-3-Clause
// Firing plans of the lidar models: which laser fires when and in which direction, and the errors that the data
// sheet gives. A new model of a known maker is a row of the table in lidar_plan.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace isobar::simulation {

/// Whose packets a model sends; one encoder each.
enum class LidarMaker : std::uint8_t { kVelodyne, kHesai, kRobosense, kOuster, kLivox };

/// What turns the beams.
enum class LidarSweep : std::uint8_t {
  kRotor,    ///< a rotor; cycles follow the sensor's clock
  kColumns,  ///< a rotor; a cycle fires at each of `columns` fixed positions of the turn
  kRosette,  ///< two mirrors at speeds without a common multiple: the pattern never repeats
};

/// Range errors and limits of a model.
struct LidarRange {
  double min_m = 0.4;
  double reach_m = 100.0;  ///< a wall of 75 % reflectivity is always detected up to there
  double sigma_low_m = 0.010;
  double sigma_high_m = 0.014;   ///< one sensor's white noise is drawn from sigma_low_m … sigma_high_m
  double bias_sigma_m = 0.006;   ///< of the constant offsets of the lasers
  double beam_rad = 0.003;       ///< divergence
  double angle_sigma_rad = 0.0;  ///< of the direction reported, white
};

/// A model. Azimuths count clockwise, seen from above.
struct LidarPlan {
  static constexpr std::size_t kMostLasers = 32;
  using Angles = std::array<double, kMostLasers>;

  std::string_view name;  ///< as in lidar.model
  LidarMaker maker = LidarMaker::kVelodyne;
  LidarSweep sweep = LidarSweep::kRotor;
  std::uint16_t port = 2368;       ///< UDP port of the data packets, factory setting
  std::uint16_t info_port = 0;     ///< of the packets with the sensor's own angles; 0: none are sent
  std::uint8_t product = 0;        ///< product id in the packets, of makers that have one
  std::size_t lasers = 16;         ///< 1 … kMostLasers
  std::size_t cycles = 24;         ///< of a packet; in a cycle every laser fires once
  double cycle_s = 1e-9 * 55'296;  ///< period of a laser; kColumns: 1 / (10 Hz · columns)
  std::size_t columns = 0;         ///< of a turn; kColumns
  double first_s = 0.0;            ///< from the start of a cycle to its first firing
  double slot_s = 0.0;             ///< from a group of lasers to the next
  Angles slot{};                   ///< by laser: its firing, in slot_s after the first
  Angles elevation_deg{};
  Angles azimuth_ahead_deg{};  ///< of the beam before the rotor
  double zero_deg = 0.0;       ///< direction of azimuth 0 in the sensor's frame, clockwise from its x axis
  /// A firing has one azimuth, that of its start: the maker's evaluation knows no turning within a cycle.
  bool one_azimuth = false;
  double distance_unit_m = 0.002;
  double origin_radius_m = 0.0;  ///< beams start on a circle around the axis, at the rotor's azimuth
  double origin_height_m = 0.0;  ///< of that circle in the sensor's frame
  LidarRange range{};

  [[nodiscard]] double packet_s() const { return static_cast<double>(cycles) * cycle_s; }
};

/// All models that can be simulated; VLP-16 is the first.
[[nodiscard]] std::span<const LidarPlan> lidar_plans();
/// @throws UsageError that lists the models, for any other name
[[nodiscard]] const LidarPlan& find_lidar_plan(std::string_view name);

}  // namespace isobar::simulation

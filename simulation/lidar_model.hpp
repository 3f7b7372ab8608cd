// SPDX-License-Identifier: BSD-3-Clause
// A VLP-16 that turns while its robot moves: every laser is fired at its own time from its own pose.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"
#include "simulation/vlp16_encoder.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Errors of one sensor. Defaults are none, for tests; draw() gives a real one.
struct LidarErrors {
  double range_sigma_m = 0.0;                        ///< white
  std::array<double, 16> range_bias_m{};             ///< a laser
  double azimuth_offset_rad = 0.0;                   ///< where the motor is at time 0
  double spin_rate_rad_s = 20.0 * 3.14159265358979;  ///< 600 rpm
  double spin_wobble_rad = 0.0;                      ///< amplitude of a slow hunting of the speed control
  double spin_wobble_hz = 0.0;
  double clock_offset_s = 0.0;    ///< sensor clock at time 0, past the hour
  double clock_drift = 0.0;       ///< sensor seconds a second, minus 1
  double latency_s = 0.0;         ///< last firing to the host's receive stamp, least
  double latency_jitter_s = 0.0;  ///< mean of the exponential part
  double reach_m = 100.0;         ///< at full reflectivity and right angle
  bool fades = false;             ///< weak and grazing returns are lost

  /// Sizes from the data sheet and from published tests, see lidar_model.cpp.
  [[nodiscard]] static LidarErrors draw(Random random);
};

/// One packet as it arrives.
struct ReceivedPacket {
  double receive_time_s = 0.0;  ///< true time; the host stamps it with its own clock
  Vlp16Bytes bytes{};
};

/// Immutable; packet() may be called from several threads, in any order.
class LidarModel {
 public:
  LidarModel(const World& world, const Trajectory& trajectory, const Eigen::Isometry3d& T_base_lidar,
             const LidarErrors& errors, std::uint64_t seed);

  /// True time of the first firing of packet n [s].
  [[nodiscard]] static double packet_time_s(std::uint64_t n);
  [[nodiscard]] ReceivedPacket packet(std::uint64_t n) const;

 private:
  [[nodiscard]] double azimuth_rad(double time_s) const;
  void fire_cycle(double time_s, std::array<LaserReturn, 16>& returns, World::Moment& moment,
                  Random& random) const;
  [[nodiscard]] LaserReturn measure(const Hit& hit, std::size_t laser, Random& random) const;

  const World& world_;
  const Trajectory& trajectory_;
  Eigen::Isometry3d T_base_lidar_;
  LidarErrors errors_;
  std::uint64_t seed_;
  std::array<double, 16> cos_elevation_{};
  std::array<double, 16> sin_elevation_{};
};

}  // namespace isobar::simulation

// SPDX-License-Identifier: BSD-3-Clause
// Model of a VLP-16 on a moving robot: each laser fires at its own time and from its own pose.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"
#include "simulation/vlp16_encoder.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Errors of one sensor. The defaults are zero, for tests.
struct LidarErrors {
  double range_sigma_m = 0.0;                        ///< white noise
  std::array<double, 16> range_bias_m{};             ///< per laser
  double azimuth_offset_rad = 0.0;                   ///< azimuth at time 0
  double spin_rate_rad_s = 20.0 * 3.14159265358979;  ///< 600 rpm
  double spin_wobble_rad = 0.0;                      ///< amplitude of a slow oscillation of the speed control
  double spin_wobble_hz = 0.0;                       ///< frequency of that oscillation
  double clock_offset_s = 0.0;                       ///< sensor clock at time 0, since the full hour
  double clock_drift = 0.0;                          ///< rate of the sensor clock minus 1
  double latency_s = 0.0;         ///< minimum time from the last firing to the host's receive stamp
  double latency_jitter_s = 0.0;  ///< mean of the exponentially distributed additional latency
  double reach_m = 100.0;         ///< range limit, and range up to which a bright wall is always detected
  bool fades = false;             ///< weak and grazing echoes are lost

  /// Random errors of the size given by data sheet and published tests; sources in lidar_model.cpp.
  [[nodiscard]] static LidarErrors draw(Random random);
};

/// One packet as received by the host.
struct ReceivedPacket {
  double receive_time_s = 0.0;  ///< true time of arrival; the host stamps it with its own clock
  Vlp16Bytes bytes{};
};

/// One sensor. Immutable: packet() may be called from several threads, in any order.
class LidarModel {
 public:
  LidarModel(const World& world, const Trajectory& trajectory, const Eigen::Isometry3d& T_base_lidar,
             const LidarErrors& errors, std::uint64_t seed);

  /// True time of the first firing of packet n [s].
  [[nodiscard]] static double packet_time_s(std::uint64_t n);
  /// Packet n = 0, 1, ….
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

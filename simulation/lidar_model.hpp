// SPDX-License-Identifier: BSD-3-Clause
// Model of a lidar on a moving robot: each laser fires at its own time and from its own pose, as its plan says.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "simulation/lidar_packet.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Errors of one sensor. The defaults are zero, for tests.
struct LidarErrors {
  double range_sigma_m = 0.0;                                 ///< white noise
  std::array<double, LidarPlan::kMostLasers> range_bias_m{};  ///< per laser
  double angle_sigma_rad = 0.0;                               ///< white noise of the direction reported
  double azimuth_offset_rad = 0.0;                            ///< azimuth at time 0
  double spin_rate_rad_s = 20.0 * 3.14159265358979;           ///< 600 rpm
  double spin_wobble_rad = 0.0;   ///< amplitude of a slow oscillation of the speed control
  double spin_wobble_hz = 0.0;    ///< frequency of that oscillation
  double clock_offset_s = 0.0;    ///< sensor clock at time 0, since its own start
  double clock_drift = 0.0;       ///< rate of the sensor clock minus 1
  double latency_s = 0.0;         ///< minimum time from the last firing to the host's receive stamp
  double latency_jitter_s = 0.0;  ///< mean of the exponentially distributed additional latency
  double reach_m = 100.0;         ///< range limit, and range up to which a bright wall is always detected
  bool fades = false;             ///< weak and grazing echoes are lost

  /// Random errors of the size that the plan's data sheet gives; other sources in lidar_model.cpp.
  [[nodiscard]] static LidarErrors draw(Random random, const LidarPlan& plan);
};

/// One packet as received by the host.
struct ReceivedPacket {
  double receive_time_s = 0.0;  ///< true time of arrival; the host stamps it with its own clock
  PacketBytes bytes;
};

/// One sensor. Immutable: packet() may be called from several threads, in any order.
class LidarModel {
 public:
  /// @param plan of lidar_plans(); must outlive the model, as world and trajectory
  LidarModel(const LidarPlan& plan, const World& world, const Trajectory& trajectory,
             const Eigen::Isometry3d& T_base_lidar, const LidarErrors& errors, std::uint64_t seed);

  /// True time of the first firing of packet n [s].
  [[nodiscard]] double packet_time_s(std::uint64_t n) const { return static_cast<double>(n) * packet_s_; }
  /// Packet n = 0, 1, ….
  [[nodiscard]] ReceivedPacket packet(std::uint64_t n) const;

 private:
  /// A ray as the sensor reports it, in its own frame.
  struct Beam {
    Eigen::Vector3d origin;
    Eigen::Vector3d direction;
  };

  [[nodiscard]] double azimuth_rad(double time_s) const;
  [[nodiscard]] Beam rotor_beam(std::size_t laser, double azimuth) const;
  [[nodiscard]] Beam rosette_beam(std::size_t laser, double time_s) const;
  void fire_cycle(double time_s, FiringCycle& cycle, World::Moment& moment, Random& random) const;
  void measure(const Hit& hit, std::size_t laser, Random& random, LaserReturn& measured) const;

  const LidarPlan& plan_;
  const World& world_;
  const Trajectory& trajectory_;
  Eigen::Isometry3d T_base_lidar_;
  LidarErrors errors_;
  std::uint64_t seed_;
  double cycle_s_;
  double packet_s_;
  std::array<double, LidarPlan::kMostLasers> cos_elevation_{};
  std::array<double, LidarPlan::kMostLasers> sin_elevation_{};
  std::array<double, LidarPlan::kMostLasers> ahead_rad_{};  ///< of x, clockwise, at azimuth 0
};

}  // namespace isobar::simulation

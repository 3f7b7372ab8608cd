// SPDX-License-Identifier: BSD-3-Clause
// What a lidar measures for one packet, and the encoders that turn it into the maker's bytes. They are written
// from the makers' documents, without the decoders of drivers/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/lidar_plan.hpp"

namespace isobar::simulation {

/// Return of one laser; distance 0: no return.
struct LaserReturn {
  double distance_m = 0.0;  ///< from the origin of the beam
  std::uint8_t reflectivity = 0;
  Eigen::Vector3d beam = Eigen::Vector3d::Zero();  ///< unit direction that the sensor reports, in its frame
};

/// One firing of all lasers.
struct FiringCycle {
  double azimuth_rad = 0.0;  ///< of the rotor at its start, clockwise seen from above, not wrapped
  std::array<LaserReturn, LidarPlan::kMostLasers> returns{};
};

struct LidarPacket {
  std::uint64_t number = 0;
  double sensor_s = 0.0;  ///< sensor clock at the start of the first cycle, since its own start
  double cycle_s = 0.0;   ///< period of the cycles on that clock
  double turn_hz = 0.0;   ///< speed of the rotor
  std::vector<FiringCycle> cycles;
};

using PacketBytes = std::vector<std::uint8_t>;

/// UDP payload of a packet, single return. Distances are rounded to the unit of the format; those that do not fit
/// become no return.
[[nodiscard]] PacketBytes encode(const LidarPlan& plan, const LidarPacket& packet);

[[nodiscard]] PacketBytes encode_velodyne(const LidarPlan& plan, const LidarPacket& packet);
[[nodiscard]] PacketBytes encode_hesai(const LidarPlan& plan, const LidarPacket& packet);
[[nodiscard]] PacketBytes encode_robosense(const LidarPlan& plan, const LidarPacket& packet);
[[nodiscard]] PacketBytes encode_ouster(const LidarPlan& plan, const LidarPacket& packet);
[[nodiscard]] PacketBytes encode_livox(const LidarPlan& plan, const LidarPacket& packet);

/// The packet with the sensor's own angles that goes to LidarPlan::info_port every second (DIFOP).
[[nodiscard]] PacketBytes encode_angles(const LidarPlan& plan);
/// The metadata of an Ouster (JSON), in the form of firmware 2.x.
[[nodiscard]] std::string ouster_metadata(const LidarPlan& plan);

/// Appends the lowest `size` bytes of a value.
void put_little(PacketBytes& bytes, std::uint64_t value, int size);
void put_big(PacketBytes& bytes, std::uint64_t value, int size);
/// Azimuth in 0.01 deg, 0 … 35999.
[[nodiscard]] std::uint32_t azimuth_counts(double azimuth_rad);
/// Distance in counts of the plan's unit; 0: no return, or one that does not fit into 16 bits.
[[nodiscard]] std::uint32_t distance_counts(const LidarPlan& plan, double distance_m);

}  // namespace isobar::simulation

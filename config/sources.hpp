// SPDX-License-Identifier: BSD-3-Clause
// Where the samples of each sensor come from: `datagram`, `dds`, `none` mean the same for every sensor, any
// other word is a driver of isobard.
#pragma once

#include <cstdint>

#include "core/name_table.hpp"

namespace isobar {

/// [lidar] source
enum class LidarSource : std::uint8_t {
  kDriver,  ///< the lidar's own packets by UDP, decoded for lidar.model
  kDds,     ///< ROS 2 topic of point clouds, received by isobar-dds
};

/// [imu] source
enum class ImuSource : std::uint8_t {
  kDatagram,  ///< sample datagrams by UDP (drivers/datagram)
  kDds,       ///< ROS 2 topic, received by isobar-dds
  kNone,      ///< the robot has none
  kVn100,     ///< VectorNav VN-100 on a serial line
  kXsens,     ///< Xsens MTi on a serial line
  kIio,       ///< IMU of the kernel's industrial I/O
  kLidar,     ///< the lidar's own, in its packets
};

/// [barometer] source
enum class BarometerSource : std::uint8_t {
  kDatagram,  ///< sample datagrams by UDP
  kDds,       ///< ROS 2 topic, received by isobar-dds
  kNone,      ///< the robot has none
  kDps310,    ///< DPS310 or DPS368 on I2C or SPI, as the four that follow
  kBmp581,
  kBmp390,
  kIcp20100,
  kMs5611,
  kSetra278,  ///< analogue transducer behind a converter of the kernel's industrial I/O
  kIio,       ///< barometer of the kernel's industrial I/O
  kImu,       ///< barometer within the IMU that this machine reads
};

/// [wheel] source
enum class WheelSource : std::uint8_t {
  kDatagram,  ///< sample datagrams by UDP
  kDds,       ///< ROS 2 topic, received by isobar-dds
  kNone,      ///< the robot has none, or they are not to be used
  kEncoder,   ///< quadrature encoders on GPIO lines of this machine
};

inline constexpr NameTable<LidarSource, 2> kLidarSourceNames{{{
    {LidarSource::kDriver, "driver"},
    {LidarSource::kDds, "dds"},
}}};

inline constexpr NameTable<ImuSource, 7> kImuSourceNames{{{
    {ImuSource::kDatagram, "datagram"},
    {ImuSource::kDds, "dds"},
    {ImuSource::kNone, "none"},
    {ImuSource::kVn100, "vn100"},
    {ImuSource::kXsens, "xsens"},
    {ImuSource::kIio, "iio"},
    {ImuSource::kLidar, "lidar"},
}}};

inline constexpr NameTable<BarometerSource, 11> kBarometerSourceNames{{{
    {BarometerSource::kDatagram, "datagram"},
    {BarometerSource::kDds, "dds"},
    {BarometerSource::kNone, "none"},
    {BarometerSource::kDps310, "dps310"},
    {BarometerSource::kBmp581, "bmp581"},
    {BarometerSource::kBmp390, "bmp390"},
    {BarometerSource::kIcp20100, "icp20100"},
    {BarometerSource::kMs5611, "ms5611"},
    {BarometerSource::kSetra278, "setra278"},
    {BarometerSource::kIio, "iio"},
    {BarometerSource::kImu, "imu"},
}}};

inline constexpr NameTable<WheelSource, 4> kWheelSourceNames{{{
    {WheelSource::kDatagram, "datagram"},
    {WheelSource::kDds, "dds"},
    {WheelSource::kNone, "none"},
    {WheelSource::kEncoder, "encoder"},
}}};

/// What a run does with a stored map.
enum class MapUse : std::uint8_t {
  kExtend,    ///< goes on in it and adds to it
  kLocalise,  ///< goes on in it and never writes it
  kNew,       ///< keeps it, and begins a new one beside it
};

inline constexpr NameTable<MapUse, 3> kMapUseNames{
    {{{MapUse::kExtend, "extend"}, {MapUse::kLocalise, "localise"}, {MapUse::kNew, "new"}}}};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
// Where the samples of each sensor come from: `datagram`, `dds`, `none` mean the same for every sensor, any
// other word is a driver of isobard.
#pragma once

#include <cstdint>

#include "core/name_table.hpp"

namespace isobar {

/// [imu] source
enum class ImuSource : std::uint8_t {
  kDatagram,  ///< sample datagrams by UDP (drivers/datagram)
  kDds,       ///< ROS 2 topic, received by isobar-dds
  kNone,      ///< the robot has none
};

/// [barometer] source
enum class BarometerSource : std::uint8_t {
  kDatagram,  ///< sample datagrams by UDP
  kNone,      ///< the robot has none
  kDps310,    ///< DPS310 or DPS368 on I2C
  kSetra278,  ///< analogue transducer behind a converter of the kernel's industrial I/O
  kIio,       ///< barometer of the kernel's industrial I/O
};

/// [wheel] source
enum class WheelSource : std::uint8_t {
  kDatagram,  ///< sample datagrams by UDP
  kDds,       ///< ROS 2 topic, received by isobar-dds
  kNone,      ///< the robot has none, or they are not to be used
};

inline constexpr NameTable<ImuSource, 3> kImuSourceNames{{{
    {ImuSource::kDatagram, "datagram"},
    {ImuSource::kDds, "dds"},
    {ImuSource::kNone, "none"},
}}};

inline constexpr NameTable<BarometerSource, 5> kBarometerSourceNames{{{
    {BarometerSource::kDatagram, "datagram"},
    {BarometerSource::kNone, "none"},
    {BarometerSource::kDps310, "dps310"},
    {BarometerSource::kSetra278, "setra278"},
    {BarometerSource::kIio, "iio"},
}}};

inline constexpr NameTable<WheelSource, 3> kWheelSourceNames{{{
    {WheelSource::kDatagram, "datagram"},
    {WheelSource::kDds, "dds"},
    {WheelSource::kNone, "none"},
}}};

}  // namespace isobar

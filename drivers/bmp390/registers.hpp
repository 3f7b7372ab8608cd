// SPDX-License-Identifier: BSD-3-Clause
// Register map of the BMP390 (Bosch data sheet BST-BMP390-DS002, chapter 4 "Global memory map").
#pragma once

#include <cstddef>
#include <cstdint>

namespace isobar::bmp390 {

inline constexpr std::uint8_t kChipId = 0x00;
inline constexpr std::uint8_t kErrors = 0x02;  ///< ERR_REG, cleared by a read
inline constexpr std::uint8_t kStatus = 0x03;
inline constexpr std::uint8_t kData =
    0x04;  ///< 3 bytes of the pressure, least significant first; then 3 of the temperature
inline constexpr std::size_t kDataBytes = 6;
inline constexpr std::uint8_t kPowerControl = 0x1B;
inline constexpr std::uint8_t kOversampling = 0x1C;  ///< OSR: osr_t << 3 | osr_p
inline constexpr std::uint8_t kRate = 0x1D;          ///< ODR: 200 Hz / 2^n
inline constexpr std::uint8_t kConfig = 0x1F;        ///< iir_filter << 1
inline constexpr std::uint8_t kCoefficientCrc = 0x30;
inline constexpr std::uint8_t kCoefficients = 0x31;
inline constexpr std::size_t kCoefficientBytes = 21;
inline constexpr std::uint8_t kCommand = 0x7E;

inline constexpr std::uint8_t kBmp390Id = 0x60;
inline constexpr std::uint8_t kSoftReset = 0xB6;
inline constexpr std::uint8_t kCommandReady = 0x10;      ///< STATUS
inline constexpr std::uint8_t kPressureReady = 0x20;     ///< STATUS, cleared when the result is read
inline constexpr std::uint8_t kTemperatureReady = 0x40;  ///< the same
inline constexpr std::uint8_t kConfigError = 0x04;  ///< ERR_REG: the oversamplings do not fit into the rate
inline constexpr std::uint8_t kNormalMode = 0x33;   ///< PWR_CTRL: normal mode, pressure, temperature

/// Content of a data register before the first measurement.
inline constexpr std::uint32_t kNoResult = 0x800000;

}  // namespace isobar::bmp390

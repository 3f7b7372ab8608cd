// SPDX-License-Identifier: BSD-3-Clause
// Register map of the DPS310 (Infineon data sheet, "Register Map" and the pages after it).
#pragma once

#include <cstddef>
#include <cstdint>

namespace isobar::dps310 {

inline constexpr std::uint8_t kPressureResult = 0x00;  ///< 3 bytes, most significant first
inline constexpr std::size_t kResultBytes = 6;         ///< 3 of the pressure, 3 of the temperature
inline constexpr std::uint8_t kTemperatureResult = 0x03;
inline constexpr std::uint8_t kPressureConfig = 0x06;     ///< PRS_CFG: rate << 4 | oversampling
inline constexpr std::uint8_t kTemperatureConfig = 0x07;  ///< TMP_CFG: the same, and kExternalThermometer
inline constexpr std::uint8_t kMeasurementConfig = 0x08;  ///< MEAS_CFG: ready bits and measurement mode
inline constexpr std::uint8_t kConfig = 0x09;             ///< CFG_REG: result shifts, FIFO, interrupts
inline constexpr std::uint8_t kInterruptStatus =
    0x0A;  ///< INT_STS, cleared by a read, and the interrupt line with it
inline constexpr std::uint8_t kReset = 0x0C;
inline constexpr std::uint8_t kProductId = 0x0D;
inline constexpr std::uint8_t kCoefficients = 0x10;
inline constexpr std::size_t kCoefficientBytes = 18;
inline constexpr std::uint8_t kCoefficientSource = 0x28;  ///< COEF_SRCE

/// TMP_CFG and COEF_SRCE: the thermometer in the pressure element, not the one in the chip.
inline constexpr std::uint8_t kExternalThermometer = 0x80;

// Bits of MEAS_CFG.
inline constexpr std::uint8_t kCoefficientsReady = 0x80;
inline constexpr std::uint8_t kSensorReady = 0x40;
inline constexpr std::uint8_t kTemperatureReady = 0x20;  ///< cleared when the result is read
inline constexpr std::uint8_t kPressureReady = 0x10;     ///< cleared when the result is read
inline constexpr std::uint8_t kModeMask = 0x0F;          ///< MEAS_CTRL, with the bit above it that reads 0
inline constexpr std::uint8_t kModeIdle = 0x00;
inline constexpr std::uint8_t kModeOneTemperature = 0x02;
inline constexpr std::uint8_t kModeBackground = 0x07;  ///< continuous pressure and temperature

// Bits of CFG_REG.
inline constexpr std::uint8_t kInterruptHigh = 0x80;      ///< INT_HL: the interrupt line is active high
inline constexpr std::uint8_t kInterruptPressure = 0x10;  ///< INT_PRS: at every new pressure
inline constexpr std::uint8_t kShiftTemperature = 0x08;   ///< required above 8 times oversampling
inline constexpr std::uint8_t kShiftPressure = 0x04;

inline constexpr std::uint8_t kSoftReset = 0x89;  ///< RESET: soft reset and empty FIFO
inline constexpr std::uint8_t kDps310Id = 0x10;   ///< revision 1, product 0

/// Content of a result register before the first measurement.
inline constexpr std::int32_t kNoResult = -0x800000;

}  // namespace isobar::dps310

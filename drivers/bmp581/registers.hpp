// SPDX-License-Identifier: BSD-3-Clause
// Register map of the BMP581 (Bosch data sheet BST-BMP581-DS004, chapter 7 "Register description").
#pragma once

#include <cstddef>
#include <cstdint>

namespace isobar::bmp581 {

inline constexpr std::uint8_t kChipId = 0x01;
inline constexpr std::uint8_t kIntSource = 0x15;
inline constexpr std::uint8_t kTemperatureData =
    0x1D;  ///< 3 bytes, least significant first; then 3 of the pressure
inline constexpr std::size_t kDataBytes = 6;
inline constexpr std::uint8_t kIntStatus = 0x27;  ///< cleared by a read
inline constexpr std::uint8_t kStatus = 0x28;
inline constexpr std::uint8_t kDspConfig = 0x30;
inline constexpr std::uint8_t kDspIir = 0x31;     ///< set_iir_p << 3 | set_iir_t
inline constexpr std::uint8_t kOsrConfig = 0x36;  ///< kPressureEnable | osr_p << 3 | osr_t
inline constexpr std::uint8_t kOdrConfig = 0x37;  ///< kDeepDisable | odr << 2 | power mode
inline constexpr std::uint8_t kOsrEffective = 0x38;
inline constexpr std::uint8_t kCommand = 0x7E;

inline constexpr std::uint8_t kBmp581Id = 0x50;
inline constexpr std::uint8_t kSoftReset = 0xB6;

inline constexpr std::uint8_t kDataReady = 0x01;      ///< INT_SOURCE, INT_STATUS: new data in the registers
inline constexpr std::uint8_t kResetComplete = 0x10;  ///< INT_STATUS: power-up or soft reset complete
inline constexpr std::uint8_t kNvmReady = 0x02;       ///< STATUS
inline constexpr std::uint8_t kNvmError = 0x04;       ///< STATUS
inline constexpr std::uint8_t kDataFiltered =
    0x28;  ///< DSP_CONFIG: the data registers come after the IIR filters
inline constexpr std::uint8_t kPressureEnable = 0x40;
inline constexpr std::uint8_t kDeepDisable = 0x80;
inline constexpr std::uint8_t kModeMask = 0x03;
inline constexpr std::uint8_t kModeStandby = 0x00;
inline constexpr std::uint8_t kModeNormal = 0x01;
inline constexpr std::uint8_t kRateValid = 0x80;  ///< OSR_EFF: the oversamplings fit into the rate

/// Content of a data register before the first measurement.
inline constexpr std::uint32_t kNoResult = 0x7F7F7F;

}  // namespace isobar::bmp581

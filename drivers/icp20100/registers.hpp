// SPDX-License-Identifier: BSD-3-Clause
// Register map of the ICP-20100 (TDK data sheet DS-000416, chapter 7 "Register map").
#pragma once

#include <cstddef>
#include <cstdint>

namespace isobar::icp20100 {

inline constexpr std::uint8_t kDummy = 0x00;  ///< read after the FIFO: ends its burst inside the chip
inline constexpr std::uint8_t kTrim1Msb = 0x05;
inline constexpr std::uint8_t kTrim2Lsb = 0x06;
inline constexpr std::uint8_t kTrim2Msb = 0x07;
inline constexpr std::uint8_t kDeviceId = 0x0C;
inline constexpr std::uint8_t kOtpConfig1 = 0xAC;
inline constexpr std::uint8_t kOtpMrLsb = 0xAD;
inline constexpr std::uint8_t kOtpMrMsb = 0xAE;
inline constexpr std::uint8_t kOtpMraLsb = 0xAF;
inline constexpr std::uint8_t kOtpMraMsb = 0xB0;
inline constexpr std::uint8_t kOtpMrbLsb = 0xB1;
inline constexpr std::uint8_t kOtpMrbMsb = 0xB2;
inline constexpr std::uint8_t kOtpAddress = 0xB5;
inline constexpr std::uint8_t kOtpCommand = 0xB6;
inline constexpr std::uint8_t kOtpData = 0xB8;
inline constexpr std::uint8_t kOtpStatus = 0xB9;
inline constexpr std::uint8_t kOtpDebug2 = 0xBC;
inline constexpr std::uint8_t kMasterLock = 0xBE;
inline constexpr std::uint8_t kOtpStatus2 = 0xBF;
inline constexpr std::uint8_t kModeSelect = 0xC0;
inline constexpr std::uint8_t kInterruptStatus = 0xC1;  ///< a bit is cleared by writing 1
inline constexpr std::uint8_t kInterruptMask = 0xC2;
inline constexpr std::uint8_t kFifoConfig = 0xC3;
inline constexpr std::uint8_t kFifoFill = 0xC4;
inline constexpr std::uint8_t kDeviceStatus = 0xCD;
inline constexpr std::uint8_t kVersion = 0xD3;
inline constexpr std::uint8_t kFifo =
    0xFA;  ///< 3 bytes of the pressure, least significant first; then 3 of the temperature
inline constexpr std::size_t kResultBytes = 6;

inline constexpr std::uint8_t kIcp20100Id = 0x63;
inline constexpr std::uint8_t kVersionA = 0x00;  ///< needs the boot sequence; version B (0xB2) does not

// MODE_SELECT: measurement configuration << 5 and these bits; FIFO of pressure and temperature.
inline constexpr std::uint8_t kModeStandby = 0x00;
inline constexpr std::uint8_t kModePowered = 0x04;
inline constexpr std::uint8_t kModeContinuous = 0x08;

inline constexpr std::uint8_t kModeAccessible = 0x01;  ///< DEVICE_STATUS: MODE_SELECT may be written
inline constexpr std::uint8_t kBooted = 0x01;          ///< OTP_STATUS2
inline constexpr std::uint8_t kOtpEnable = 0x01;       ///< OTP_CONFIG1
inline constexpr std::uint8_t kOtpWriteSwitch = 0x02;  ///< OTP_CONFIG1
inline constexpr std::uint8_t kOtpReset = 0x80;        ///< OTP_DBG2
inline constexpr std::uint8_t kOtpRead = 0x10;         ///< OTP_COMMAND
inline constexpr std::uint8_t kUnlock = 0x1F;          ///< MASTER_LOCK
inline constexpr std::uint8_t kFlush = 0x80;           ///< FIFO_FILL
inline constexpr std::uint8_t kFillMask = 0x1F;        ///< FIFO_FILL: results waiting
inline constexpr int kFifoDepth = 16;

// Masks of the trimming fields, and the addresses of their values in the one-time programmable memory.
inline constexpr std::uint8_t kOffsetMask = 0x3F;      ///< TRIM1_MSB
inline constexpr std::uint8_t kGainMask = 0x70;        ///< TRIM2_MSB
inline constexpr std::uint8_t kOscillatorMask = 0x7F;  ///< TRIM2_LSB
inline constexpr std::uint8_t kOtpOffset = 0xF8;
inline constexpr std::uint8_t kOtpGain = 0xF9;
inline constexpr std::uint8_t kOtpOscillator = 0xFA;

}  // namespace isobar::icp20100

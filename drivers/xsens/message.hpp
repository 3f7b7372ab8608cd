// SPDX-License-Identifier: BSD-3-Clause
// Messages of the XBus protocol: preamble 0xFA, bus address, message id, length, data, checksum; big-endian
// ("MT Low Level Communication Protocol", MT0101P).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isobar::xsens {

inline constexpr std::uint8_t kPreamble = 0xFA;
/// Bus address of a single device, "master".
inline constexpr std::uint8_t kMaster = 0xFF;

/// Message ids that are used here. An acknowledgement has the id of its command plus one.
enum class Id : std::uint8_t {
  kGoToMeasurement = 0x10,
  kGoToMeasurementAck = 0x11,
  kGoToConfig = 0x30,
  kGoToConfigAck = 0x31,
  kData = 0x36,        ///< MTData2
  kLegacyData = 0x32,  ///< MTData of the MTi and MTx before 2012: data of a form that is told elsewhere
  kWakeUp = 0x3E,
  kError = 0x42,
  kSetOutput = 0xC0,  ///< SetOutputConfiguration
  kSetOutputAck = 0xC1,
};

enum class MessageForm : std::uint8_t {
  kIncomplete,  ///< may become a message with more bytes
  kWhole,       ///< of a used id, checksum holds, and the items of kData fill it exactly
  kCorrupt,     ///< all bytes of a kData, another checksum
  kNone,        ///< no message of a used id starts here
};

struct MessageSize {
  MessageForm form = MessageForm::kNone;
  std::size_t header_bytes = 0;  ///< 4, or 6 with an extended length
  std::size_t data_bytes = 0;
  [[nodiscard]] std::size_t bytes() const noexcept { return header_bytes + data_bytes + 1; }
};

/// Form of what starts at the first byte.
[[nodiscard]] MessageSize measure_message(std::span<const std::uint8_t> bytes) noexcept;

/// A message to send.
[[nodiscard]] std::vector<std::uint8_t> make_message(Id id, std::span<const std::uint8_t> data);

/// Code of an error message in words; nullptr: unknown.
[[nodiscard]] const char* error_words(int code) noexcept;

}  // namespace isobar::xsens

// SPDX-License-Identifier: BSD-3-Clause
// Lines of text: commands to the sensor, its answers, and sentences of NMEA 0183: `$…*checksum`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace isobar::vn100 {

/// Exclusive or of the characters between '$' and '*'.
[[nodiscard]] std::uint8_t checksum8(std::string_view text) noexcept;

enum class LineForm : std::uint8_t { kIncomplete, kWhole, kNone };
struct LineSize {
  LineForm form = LineForm::kNone;
  std::size_t bytes = 0;  ///< from '$' to the last digit of the checksum
};
/// Form of what starts at the first byte. kWhole: the checksum, 8 or 16 bits, holds.
[[nodiscard]] LineSize measure_line(std::span<const std::uint8_t> bytes) noexcept;

/// "$VNWRG,06,0*6C\r\n" of "VNWRG,06,0".
[[nodiscard]] std::string command_line(const std::string& body);

/// An answer to a register command.
struct Answer {
  std::string_view kind;    ///< "WRG", "RRG", "ERR"
  int number = -1;          ///< register, or code of an error
  std::string_view values;  ///< what follows the number's comma, up to '*'
};
/// @param line whole, see measure_line(); nothing: not a line of a VectorNav sensor, or without a number
[[nodiscard]] std::optional<Answer> parse_answer(std::string_view line) noexcept;

/// True when a list of numbers begins with those of another: the sensor writes 05 or 5, 0030 or 30, and newer
/// firmware appends the port to a register's values. Compared in base 16, in which both spellings of any base
/// are equal numbers.
[[nodiscard]] bool begins_with_numbers(std::string_view list, std::string_view beginning) noexcept;

/// Error code of $VNERR in words (UM001, "System Error Codes"); nullptr: unknown.
[[nodiscard]] const char* error_words(int code) noexcept;
/// The error is an answer to a command; the others report the state of the sensor.
[[nodiscard]] bool is_refusal(int code) noexcept;

}  // namespace isobar::vn100

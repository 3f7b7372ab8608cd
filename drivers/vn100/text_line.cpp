// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/text_line.hpp"

#include <array>
#include <charconv>
#include <cstdio>

#include "drivers/vn100/binary_packet.hpp"

namespace isobar::vn100 {

namespace {

/// Longest line: NMEA allows 82 characters, the sensor's longest (register 83) has about 200.
constexpr std::size_t kMaxLineBytes = 512;

bool is_hex(std::uint8_t c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F') || (c >= 'a' && c <= 'f');
}

template <class Number>
bool parse_number(std::string_view text, Number& value, int base) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Splits off the text before the first comma.
std::string_view take_part(std::string_view& text) {
  const std::size_t comma = text.find(',');
  const std::string_view part = text.substr(0, comma);
  text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
  return part;
}

bool checksum_holds(std::span<const std::uint8_t> body, std::string_view digits) {
  unsigned sum = 0;
  if (!parse_number(digits, sum, 16)) return false;
  if (digits.size() == 4) return sum == crc16(body);
  return digits.size() == 2 && sum == checksum8({reinterpret_cast<const char*>(body.data()), body.size()});
}

}  // namespace

std::uint8_t checksum8(std::string_view text) noexcept {
  std::uint8_t sum = 0;
  for (const char c : text) sum ^= static_cast<std::uint8_t>(c);
  return sum;
}

LineSize measure_line(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.empty() || bytes[0] != '$') return {};
  std::size_t star = 1;
  while (star < bytes.size() && bytes[star] != '*') {
    const std::uint8_t c = bytes[star];
    if (c < ' ' || c > '~' || c == '$' || star > kMaxLineBytes) return {};
    ++star;
  }
  std::size_t end = star + 1;
  while (end < bytes.size() && end <= star + 4 && is_hex(bytes[end])) ++end;
  // The character behind the last digit tells two digits from four.
  if (end >= bytes.size()) return {LineForm::kIncomplete, 0};
  const std::string_view digits(reinterpret_cast<const char*>(bytes.data()) + star + 1, end - star - 1);
  if (!checksum_holds(bytes.subspan(1, star - 1), digits)) return {};
  return {LineForm::kWhole, end};
}

std::string command_line(const std::string& body) {
  std::array<char, 8> sum{};
  std::snprintf(sum.data(), sum.size(), "*%02X\r\n", static_cast<unsigned>(checksum8(body)));
  return "$" + body + sum.data();
}

std::optional<Answer> parse_answer(std::string_view line) noexcept {
  constexpr std::string_view kStart = "$VN";
  if (!line.starts_with(kStart)) return std::nullopt;
  std::string_view rest = line.substr(kStart.size(), line.find('*') - kStart.size());
  Answer answer;
  answer.kind = take_part(rest);
  const std::string_view number = take_part(rest);
  // Codes of errors are hexadecimal, registers decimal; all that are used here have one digit or no letter.
  if (!parse_number(number, answer.number, answer.kind == "ERR" ? 16 : 10)) return std::nullopt;
  answer.values = rest;
  return answer;
}

bool begins_with_numbers(std::string_view list, std::string_view beginning) noexcept {
  while (!beginning.empty()) {
    unsigned held = 0;
    unsigned wanted = 0;
    if (!parse_number(take_part(list), held, 16) || !parse_number(take_part(beginning), wanted, 16))
      return false;
    if (held != wanted) return false;
  }
  return true;
}

const char* error_words(int code) noexcept {
  constexpr std::array<const char*, 13> kWords{nullptr,
                                               "hard fault of the processor",
                                               "its receive buffer overflows",
                                               "wrong checksum",
                                               "unknown command",
                                               "too few parameters",
                                               "too many parameters",
                                               "invalid parameter",
                                               "no such register",
                                               "register may not be written",
                                               "watchdog reset",
                                               "its transmit buffer overflows: baud rate too low",
                                               "baud rate too low for this output"};
  const bool known = code > 0 && static_cast<std::size_t>(code) < kWords.size();
  return known ? kWords[static_cast<std::size_t>(code)] : nullptr;
}

bool is_refusal(int code) noexcept { return (code >= 4 && code <= 9) || code == 12; }

}  // namespace isobar::vn100

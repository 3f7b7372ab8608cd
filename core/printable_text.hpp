// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace isobar {

/// Length of the UTF-8 sequence at the start of `text` [bytes]; 0 where it is invalid: overlong, a surrogate,
/// beyond U+10FFFF or cut. RFC 3629, section 4.
inline std::size_t utf8_sequence(std::string_view text) {
  const auto byte = [&text](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto continues = [&byte](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i <= last; ++i) {
      if ((byte(i) & 0xC0U) != 0x80U) return false;
    }
    return true;
  };
  const unsigned lead = byte(0);
  if (text.empty()) return 0;
  if (lead < 0x80U) return 1;
  if (lead >= 0xC2U && lead <= 0xDFU) return continues(1, 1) ? 2 : 0;
  if (lead >= 0xE0U && lead <= 0xEFU) {
    const bool valid = (lead != 0xE0U || byte(1) >= 0xA0U) && (lead != 0xEDU || byte(1) <= 0x9FU);
    return valid && continues(1, 2) ? 3 : 0;
  }
  if (lead >= 0xF0U && lead <= 0xF4U) {
    const bool valid = (lead != 0xF0U || byte(1) >= 0x90U) && (lead != 0xF4U || byte(1) <= 0x8FU);
    return valid && continues(1, 3) ? 4 : 0;
  }
  return 0;
}

/// Foreign text as part of an error or a log line: control characters and invalid UTF-8 as \xNN, at most
/// `most` characters, then an ellipsis. Foreign bytes can then neither fill a log nor steer a terminal.
inline std::string printable(std::string_view text, std::size_t most = 80) {
  constexpr const char* kHexDigits = "0123456789ABCDEF";
  std::string result;
  for (std::size_t characters = 0; !text.empty(); ++characters) {
    if (characters == most) return result + "…";
    const std::size_t length = utf8_sequence(text);
    const auto lead = static_cast<unsigned char>(text.front());
    // C1 controls, U+0080 … U+009F, are C2 80 … C2 9F.
    const bool is_c1 = length == 2 && lead == 0xC2U && static_cast<unsigned char>(text[1]) < 0xA0U;
    if (length == 0 || is_c1 || lead < 0x20U || lead == 0x7FU) {
      result += "\\x";
      result += kHexDigits[lead / 16];
      result += kHexDigits[lead % 16];
      text.remove_prefix(1);
    } else {
      result += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
  return result;
}

}  // namespace isobar

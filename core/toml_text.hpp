// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace isobar {

/// `text` as a basic string of TOML 1.0: in quotation marks, control characters escaped.
inline std::string quoted_toml(const std::string& text) {
  constexpr const char* kHexDigits = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || code == 0x7F) {
      result += "\\u00";
      result += kHexDigits[code / 16];
      result += kHexDigits[code % 16];
    } else {
      result += c;
    }
  }
  return result + "\"";
}

}  // namespace isobar

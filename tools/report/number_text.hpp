// SPDX-License-Identifier: BSD-3-Clause
// Numbers and text for tables, reports and the terminal.
#pragma once

#include <string>
#include <string_view>

namespace isobar::report {

/// Escapes text for use between tags and in attributes; drops control characters.
std::string escaped(std::string_view text);

/// A number with fixed decimals; "–" for NaN; "0", never "-0".
std::string fixed(double value, int decimals);

/// Like fixed(), with a plus sign for positive numbers and U+2212 as minus sign.
std::string fixed_signed(double value, int decimals);

}  // namespace isobar::report

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace isobar::text {

/// Most parts of a dotted key or header, and most arrays and inline tables inside each other. The deepest key
/// of Isobar has three parts.
inline constexpr std::size_t kMostKeyParts = 16;
inline constexpr std::size_t kMostNesting = 16;

/// A broken rule and its place.
struct TextFault {
  std::uint32_t line = 1;
  std::uint32_t column = 1;  ///< [bytes]
  std::string rule;
};

/// Checks a TOML text before it is parsed: UTF-8 without control characters, bounded nesting. toml++ 3.3
/// recurses once a level, also in its destructors, so that a deep text would overflow the stack.
[[nodiscard]] std::optional<TextFault> toml_fault(std::string_view text);

}  // namespace isobar::text

// SPDX-License-Identifier: BSD-3-Clause
// Bytes of numbers and texts as MCAP stores them: little endian, without padding, lengths before contents.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace isobar::mcap {

using Bytes = std::vector<std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "numbers are stored as their bytes in memory");

template <typename Number>
void put(Number value, Bytes& out) {
  static_assert(std::is_arithmetic_v<Number>);
  const std::size_t begin = out.size();
  out.resize(begin + sizeof value);
  std::memcpy(out.data() + begin, &value, sizeof value);
}

/// Length in 32 bits, then the letters.
inline void put_text(std::string_view text, Bytes& out) {
  put(static_cast<std::uint32_t>(text.size()), out);
  out.insert(out.end(), text.begin(), text.end());
}

}  // namespace isobar::mcap

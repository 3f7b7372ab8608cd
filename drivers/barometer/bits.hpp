// SPDX-License-Identifier: BSD-3-Clause
// Integers of 16 and 24 bit in rows of registers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace isobar {

/// The lowest `bits` of a word as a two's complement number.
[[nodiscard]] constexpr std::int32_t signed_field(std::uint32_t word, int bits) noexcept {
  return static_cast<std::int32_t>(word << (32 - bits)) >> (32 - bits);
}

/// Least significant byte first. @param at index of the first byte
[[nodiscard]] constexpr std::uint16_t little_u16(std::span<const std::uint8_t> bytes,
                                                 std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}
[[nodiscard]] constexpr std::uint32_t little_u24(std::span<const std::uint8_t> bytes,
                                                 std::size_t at) noexcept {
  return static_cast<std::uint32_t>(bytes[at] | bytes[at + 1] << 8U | bytes[at + 2] << 16U);
}

/// log2 of a power of two: index of tables and value of registers.
[[nodiscard]] constexpr std::uint8_t index_of_power(int power_of_two) noexcept {
  return static_cast<std::uint8_t>(std::countr_zero(static_cast<unsigned>(power_of_two)));
}

}  // namespace isobar

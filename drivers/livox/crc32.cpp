// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "drivers/livox/packet_format.hpp"

namespace isobar::livox {
namespace {

constexpr std::uint32_t kReflectedPolynomial = 0xEDB8'8320;

constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit)
      rest = (rest & 1U) != 0 ? rest >> 1U ^ kReflectedPolynomial : rest >> 1U;
    table[byte] = rest;
  }
  return table;
}

constexpr auto kTable = make_table();

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t rest = 0xFFFF'FFFF;
  for (const std::uint8_t byte : bytes) rest = rest >> 8U ^ kTable[(rest ^ byte) & 0xFFU];
  return rest ^ 0xFFFF'FFFF;
}

}  // namespace isobar::livox

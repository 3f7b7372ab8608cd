// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/ouster/captures.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace isobar::test {

std::uint64_t bytes_at(const std::vector<std::uint8_t>& packet, int at, int count) {
  std::uint64_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = value << 8U | packet.at(static_cast<std::size_t>(at + i));
  return value;
}

std::vector<CapturedPacket> read_capture(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::vector<CapturedPacket> packets;
  CapturedPacket open;
  for (std::size_t at = 24; at + 16 <= text.size();) {
    const auto word = [&text](std::size_t i) {
      return static_cast<std::int64_t>(bytes_at(text, static_cast<int>(i), 4));
    };
    const std::int64_t stamp_ns = word(at) * 1'000'000'000 + word(at + 4) * 1'000;
    const auto length = static_cast<std::size_t>(word(at + 8));
    const std::size_t ip = at + 16 + 14;
    const unsigned flags = static_cast<unsigned>(text[ip + 6] << 8U | text[ip + 7]);
    const auto from = text.begin() + static_cast<std::ptrdiff_t>(ip + 20);
    const auto to = text.begin() + static_cast<std::ptrdiff_t>(at + 16 + length);
    if ((flags & 0x1FFFU) == 0) {
      open = {stamp_ns, static_cast<std::uint16_t>(from[2] << 8U | from[3]), {from + 8, to}};
    } else {
      open.bytes.insert(open.bytes.end(), from, to);
    }
    if ((flags & 0x2000U) == 0) packets.push_back(open);
    at += 16 + length;
  }
  return packets;
}

int column_at(const FieldPlan& plan, int column) {
  return plan.packet_header + column * (plan.column_header + plan.rows * plan.pixel + plan.column_footer);
}

std::uint32_t pixel_value(const FieldPlan& plan, const PixelField& field,
                          const std::vector<std::uint8_t>& packet, int column, int row) {
  const int at = column_at(plan, column) + plan.column_header + row * plan.pixel + field.offset;
  const auto raw = static_cast<std::uint32_t>(bytes_at(packet, at, field.bytes));
  return (raw & field.mask) >> static_cast<unsigned>(field.down) << static_cast<unsigned>(field.up);
}

bool is_valid_column(const FieldPlan& plan, const std::vector<std::uint8_t>& packet, int column) {
  if (plan.column_footer > 0) return bytes_at(packet, column_at(plan, column + 1) - 4, 4) == 0xFFFF'FFFF;
  return (bytes_at(packet, column_at(plan, column) + 10, 2) & 1U) != 0;
}

std::string md5(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_md5(), nullptr);
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    std::array<char, 3> hex{};
    std::snprintf(hex.data(), hex.size(), "%02x", digest[i]);
    text += hex.data();
  }
  return text;
}

}  // namespace isobar::test

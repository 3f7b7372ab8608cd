// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/xsens/data_items.hpp"

#include <bit>

namespace isobar::xsens {

namespace {

constexpr std::size_t kItemHeader = 3;

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8U | byte;
  return value;
}

std::size_t number_bytes(Precision precision) {
  switch (precision) {
    case Precision::kFloat32:
    case Precision::kFixed12Point20:
      return 4;
    case Precision::kFixed16Point32:
      return 6;
    case Precision::kFloat64:
      return 8;
  }
  return 8;
}

/// The fraction of 32 bits comes first, then the integer part of 16 bits.
double fixed_16_point_32(std::span<const std::uint8_t> bytes) {
  constexpr double kFractions = 4294967296.0;  // 2^32
  const auto whole = static_cast<std::int16_t>(big_endian(bytes.subspan(4, 2)));
  return whole + static_cast<double>(big_endian(bytes.first(4))) / kFractions;
}

}  // namespace

std::optional<World> DataItem::world() const noexcept {
  const unsigned bits = id >> 2U & 3U;
  return bits < 3 ? std::optional(static_cast<World>(bits)) : std::nullopt;
}

bool DataItem::has_numbers(std::size_t count) const noexcept {
  return data.size() == count * number_bytes(precision());
}

double DataItem::number(std::size_t index) const noexcept {
  const std::size_t length = number_bytes(precision());
  const std::span<const std::uint8_t> bytes = data.subspan(index * length, length);
  switch (precision()) {
    case Precision::kFloat32:
      return double{std::bit_cast<float>(static_cast<std::uint32_t>(big_endian(bytes)))};
    case Precision::kFixed12Point20:
      return static_cast<std::int32_t>(big_endian(bytes)) / 1048576.0;  // 2^20
    case Precision::kFixed16Point32:
      return fixed_16_point_32(bytes);
    case Precision::kFloat64:
      return std::bit_cast<double>(big_endian(bytes));
  }
  return 0.0;
}

std::uint64_t DataItem::integer(std::size_t bytes) const noexcept { return big_endian(data.first(bytes)); }

bool items_fill(std::span<const std::uint8_t> data) noexcept {
  if (data.empty()) return false;
  while (data.size() >= kItemHeader) {
    const std::size_t bytes = kItemHeader + data[2];
    if (bytes > data.size()) return false;
    data = data.subspan(bytes);
  }
  return data.empty();
}

std::optional<DataItem> take_item(std::span<const std::uint8_t>& data) noexcept {
  if (data.size() < kItemHeader || data.size() < kItemHeader + data[2]) return std::nullopt;
  const DataItem item{static_cast<std::uint16_t>(big_endian(data.first(2))),
                      data.subspan(kItemHeader, data[2])};
  data = data.subspan(kItemHeader + item.data.size());
  return item;
}

}  // namespace isobar::xsens

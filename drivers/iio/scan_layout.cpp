// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/scan_layout.hpp"

#include <algorithm>
#include <charconv>

namespace isobar::iio {

namespace {

std::size_t aligned(std::size_t at, std::size_t size) { return (at + size - 1) / size * size; }

/// Takes a number, and the text `behind` it, off the text.
bool take_number(std::string_view& text, int& value, std::string_view behind) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (!text.starts_with(behind)) return false;
  text.remove_prefix(behind.size());
  return true;
}

}  // namespace

std::optional<ElementType> parse_element_type(std::string_view text) noexcept {
  ElementType type;
  type.big_endian = text.starts_with("be:");
  if (!type.big_endian && !text.starts_with("le:")) return std::nullopt;
  text.remove_prefix(3);
  if (text.empty() || (text[0] != 's' && text[0] != 'u')) return std::nullopt;
  type.is_signed = text[0] == 's';
  text.remove_prefix(1);
  int storage_bits = 0;
  if (!take_number(text, type.bits, "/") || !take_number(text, storage_bits, ">>") ||
      !take_number(text, type.shift, "") || !text.empty()) {
    return std::nullopt;
  }
  type.storage_bytes = storage_bits / 8;
  const bool whole = storage_bits == 8 || storage_bits == 16 || storage_bits == 32 || storage_bits == 64;
  const bool fits = type.bits > 0 && type.shift >= 0 && type.bits + type.shift <= storage_bits;
  return whole && fits ? std::optional(type) : std::nullopt;
}

std::int64_t ElementType::value(std::span<const std::uint8_t> bytes) const noexcept {
  std::uint64_t raw = 0;
  const auto count = static_cast<std::size_t>(storage_bytes);
  for (std::size_t i = 0; i < count; ++i) {
    raw = raw << 8U | bytes[big_endian ? i : count - 1 - i];
  }
  // The value's highest bit to bit 63, and back with or without its sign.
  const int left = 64 - bits;
  const std::uint64_t top = raw >> shift << left;
  return is_signed ? static_cast<std::int64_t>(top) >> left : static_cast<std::int64_t>(top >> left);
}

bool ScanLayout::finish() noexcept {
  std::array<Element*, kImuChannels.size()> order{};
  std::size_t count = 0;
  for (Element& element : elements_) {
    if (element.used) order[count++] = &element;
  }
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(order.begin(), end, [](const Element* a, const Element* b) { return a->index < b->index; });
  std::size_t at = 0;
  std::size_t largest = 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && order[i]->index == order[i - 1]->index) return false;
    const auto size = static_cast<std::size_t>(order[i]->type.storage_bytes);
    order[i]->at = aligned(at, size);
    at = order[i]->at + size;
    largest = std::max(largest, size);
  }
  scan_bytes_ = aligned(at, largest);
  return true;
}

std::int64_t ScanLayout::value(std::span<const std::uint8_t> scan, std::size_t channel) const noexcept {
  const Element& element = elements_[channel];
  return element.type.value(scan.subspan(element.at, static_cast<std::size_t>(element.type.storage_bytes)));
}

}  // namespace isobar::iio

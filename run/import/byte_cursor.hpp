// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace isobar::imports {

/// Reads packed little-endian fields. Past the end everything reads as zero or empty, and ok() is false for ever.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <typename Value>
  Value get() {
    static_assert(std::is_arithmetic_v<Value>);
    Value value{};
    const std::span<const std::uint8_t> from = take(sizeof(Value));
    if (from.size() == sizeof(Value)) std::memcpy(&value, from.data(), sizeof(Value));
    return value;
  }
  /// The next `size` bytes; none where there are fewer.
  std::span<const std::uint8_t> take(std::uint64_t size) {
    if (!ok_ || size > bytes_.size() - at_) {
      ok_ = false;
      return {};
    }
    const auto part = bytes_.subspan(at_, size);
    at_ += size;
    return part;
  }
  /// Bytes behind their number, of 32 bits.
  std::span<const std::uint8_t> counted() { return take(get<std::uint32_t>()); }
  /// The same as text.
  std::string_view text() {
    const auto part = counted();
    return {reinterpret_cast<const char*>(part.data()), part.size()};
  }

  /// What follows is of no known form.
  void fail() { ok_ = false; }

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return ok_ ? bytes_.size() - at_ : 0; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace isobar::imports

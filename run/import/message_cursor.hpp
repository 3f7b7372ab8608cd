// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "run/import/byte_cursor.hpp"
#include "run/import/message_stream.hpp"

namespace isobar::imports {

/// Reads the fields of a ROS message in their order, in the serialisation of ROS 1 (little-endian, packed) or of ROS 2
/// (plain CDR of either byte order: OMG DDSI-RTPS 2.2, section 10; primitives are aligned to their size, counted from
/// behind the encapsulation header). Past the end everything reads as zero or empty, and ok() is false for ever.
class MessageCursor {
 public:
  MessageCursor(std::span<const std::uint8_t> bytes, Encoding encoding)
      : bytes_(bytes), is_ros1_(encoding == Encoding::kRos1) {
    if (is_ros1_) return;
    constexpr std::size_t kEncapsulationBytes = 4;
    // CDR_BE and CDR_LE; the others (XCDR2, parameter lists) lay fields out in another way.
    const bool is_cdr =
        encoding == Encoding::kCdr && bytes.size() >= kEncapsulationBytes && bytes[0] == 0 && bytes[1] <= 1;
    if (!is_cdr) {
      bytes_.fail();
      return;
    }
    swaps_ = bytes[1] == 0;
    bytes_ = ByteCursor(bytes.subspan(kEncapsulationBytes));
  }

  template <typename Value>
  Value get() {
    static_assert(std::is_arithmetic_v<Value>);
    align(sizeof(Value));
    Value value{};
    const auto from = take(sizeof(Value));
    if (from.size() != sizeof(Value)) return value;
    std::memcpy(&value, from.data(), sizeof(Value));
    if (swaps_ && sizeof(Value) > 1) {
      std::uint8_t turned[sizeof(Value)];  // NOLINT(modernize-avoid-c-arrays)
      std::reverse_copy(from.begin(), from.end(), turned);
      std::memcpy(&value, turned, sizeof(Value));
    }
    return value;
  }
  /// Bytes as they are: an array of a fixed length.
  std::span<const std::uint8_t> take(std::uint64_t size) { return bytes_.take(size); }
  /// A sequence of bytes.
  std::span<const std::uint8_t> blob() { return take(get<std::uint32_t>()); }
  /// Length of a sequence whose elements take at least `least_bytes` each; 0 where they would not fit.
  std::uint32_t count(std::size_t least_bytes) {
    const auto number = get<std::uint32_t>();
    if (std::size_t{number} * least_bytes > left()) bytes_.fail();
    return ok() ? number : 0;
  }
  std::string_view text() {
    const auto part = blob();
    std::string_view text(reinterpret_cast<const char*>(part.data()), part.size());
    if (!is_ros1_ && text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }
  /// builtin_interfaces/Time, or the time of ROS 1 [ns].
  std::int64_t time_ns() {
    const std::int64_t seconds =
        is_ros1_ ? std::int64_t{get<std::uint32_t>()} : std::int64_t{get<std::int32_t>()};
    return seconds * 1'000'000'000 + get<std::uint32_t>();
  }
  template <typename Value>
  void skip(std::size_t values) {
    for (std::size_t i = 0; i < values; ++i) get<Value>();
  }

  [[nodiscard]] bool ok() const { return bytes_.ok(); }
  [[nodiscard]] bool is_ros1() const { return is_ros1_; }
  [[nodiscard]] std::size_t left() const { return bytes_.left(); }

 private:
  void align(std::size_t size) {
    if (is_ros1_) return;
    const std::size_t beyond = bytes_.at() % size;
    if (beyond != 0) take(size - beyond);
  }

  ByteCursor bytes_;
  bool is_ros1_;
  bool swaps_ = false;
};

}  // namespace isobar::imports

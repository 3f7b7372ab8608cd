// SPDX-License-Identifier: BSD-3-Clause
// Serialisation of ROS 2 messages: CDR, little endian (OMG DDS-XTypes 1.3, 7.4.3, XCDR version 1).
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace isobar::mcap {

/// Members are written in the order of the definition; each number stands at a multiple of its size behind the four bytes
/// of the encapsulation header.
class CdrWriter {
 public:
  CdrWriter() : bytes_{0x00, 0x01, 0x00, 0x00} {}

  template <typename Number>
  CdrWriter& put(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    while ((bytes_.size() - kHeaderBytes) % sizeof value != 0) bytes_.push_back(0);
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + sizeof value);
    std::memcpy(bytes_.data() + begin, &value, sizeof value);
    return *this;
  }

  /// Length with the closing zero, letters, zero.
  CdrWriter& text(std::string_view value) {
    count(value.size() + 1);
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    bytes_.push_back(0);
    return *this;
  }

  /// Number of elements that follow.
  CdrWriter& count(std::size_t elements) { return put(static_cast<std::uint32_t>(elements)); }

  CdrWriter& raw(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }

  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kHeaderBytes = 4;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace isobar::mcap

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace isobar::serial {

/// Received bytes that no message has used up so far, in one piece: filled at its end, emptied at its start.
///
///     window.filled(read(window.room()));
///     while (… window.bytes() …) window.drop(n);
class ByteWindow {
 public:
  static constexpr std::size_t kBytes = 4096;

  /// Free bytes to read into; invalidates earlier results of bytes().
  [[nodiscard]] std::span<std::uint8_t> room() noexcept {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    return std::span(buffer_).subspan(end_);
  }
  /// `count` bytes were read into room().
  void filled(std::size_t count) noexcept { end_ = std::min(end_ + count, kBytes); }
  [[nodiscard]] std::span<const std::uint8_t> bytes() const noexcept {
    return std::span(buffer_).subspan(begin_, end_ - begin_);
  }
  void drop(std::size_t count) noexcept { begin_ = std::min(begin_ + count, end_); }
  void clear() noexcept { begin_ = end_ = 0; }

 private:
  std::array<std::uint8_t, kBytes> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace isobar::serial

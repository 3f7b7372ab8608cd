// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/serial/byte_window.hpp"
#include "drivers/xsens/message.hpp"

namespace isobar::xsens {

/// A message of the stream; valid until the parser's next room().
struct Frame {
  bool found = false;
  Id id = Id::kData;
  std::span<const std::uint8_t> bytes;  ///< from the preamble to the checksum
  std::span<const std::uint8_t> data;
  std::size_t bytes_on_line = 0;  ///< received bytes from the first of these to the newest
};

/// Splits a stream of bytes into messages that are sound (MessageForm::kWhole). Whatever else is between them
/// is skipped by the byte, so that a wrong length or a preamble within other data costs no message that
/// follows.
class StreamParser {
 public:
  struct Counters {
    std::uint64_t messages = 0;
    std::uint64_t corrupt = 0;  ///< MTData2 with a wrong checksum
    std::uint64_t skipped = 0;  ///< bytes of no message
  };

  [[nodiscard]] std::span<std::uint8_t> room() noexcept { return window_.room(); }
  void filled(std::size_t count) noexcept;
  /// The next message; none found: it needs more bytes.
  Frame next() noexcept;
  /// What is incomplete stays so: the end of the stream, or a pause on the line.
  void give_up_incomplete() noexcept { given_up_ = true; }
  /// Forgets all bytes; the counters stay.
  void restart() noexcept;
  [[nodiscard]] const Counters& counters() const noexcept { return counters_; }

 private:
  /// Offset of a whole MTData2 behind the first byte; 0: none.
  [[nodiscard]] std::size_t data_behind() const noexcept;
  void skip(std::size_t count) noexcept;

  serial::ByteWindow window_;
  bool given_up_ = false;
  Counters counters_;
};

}  // namespace isobar::xsens

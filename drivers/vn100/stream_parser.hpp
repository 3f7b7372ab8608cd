// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/serial/byte_window.hpp"
#include "drivers/vn100/binary_packet.hpp"

namespace isobar::vn100 {

/// A message of the stream; valid until the parser's next room().
struct Frame {
  enum class Kind : std::uint8_t { kNone, kBinary, kText };
  Kind kind = Kind::kNone;
  std::span<const std::uint8_t> bytes;  ///< from the sync byte to the CRC, or from '$' to the checksum
  std::size_t bytes_on_line = 0;        ///< received bytes from the first of these to the newest

  [[nodiscard]] std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

/// Splits a stream of bytes into binary packets whose CRC holds, and lines of the form `$…*checksum` (VectorNav
/// and NMEA 0183, 8-bit sum or 16-bit CRC) whose checksum holds. Whatever else is between them is skipped by
/// the byte, so that a wrong length or a sync byte within other data costs no message that follows.
class StreamParser {
 public:
  struct Counters {
    std::uint64_t packets = 0;  ///< binary packets
    std::uint64_t lines = 0;    ///< lines of text
    std::uint64_t corrupt = 0;  ///< packets with the header of the last good one and a wrong CRC
    std::uint64_t skipped = 0;  ///< bytes of no message
  };

  [[nodiscard]] std::span<std::uint8_t> room() noexcept { return window_.room(); }
  void filled(std::size_t count) noexcept;
  /// The next message; kNone: it needs more bytes.
  Frame next() noexcept;
  /// What is incomplete stays so: the end of the stream, or a pause on the line.
  void give_up_incomplete() noexcept { given_up_ = true; }
  /// Forgets all bytes; the counters stay.
  void restart() noexcept;
  [[nodiscard]] const Counters& counters() const noexcept { return counters_; }

  /// Header of packets whose length is unknown, and how often it came more than others of the kind: packets of such a
  /// form repeat it, false sync bytes do not.
  [[nodiscard]] std::span<const std::uint8_t> unknown_header() const noexcept {
    return std::span(unknown_header_).first(unknown_bytes_);
  }
  [[nodiscard]] int unknown_headers() const noexcept { return unknown_count_; }

 private:
  void note_unknown(std::span<const std::uint8_t> header) noexcept;
  Frame take_packet(const PacketSize& size) noexcept;
  /// Offset of a whole packet with the header of the last good one behind the first byte; 0: none.
  [[nodiscard]] std::size_t known_packet_behind() const noexcept;
  [[nodiscard]] bool has_known_header(std::span<const std::uint8_t> bytes) const noexcept;
  void skip(std::size_t count) noexcept;

  serial::ByteWindow window_;
  bool given_up_ = false;
  std::array<std::uint8_t, 16> header_{};  ///< of the last good packet
  std::size_t header_bytes_ = 0;
  std::array<std::uint8_t, 16> unknown_header_{};
  std::size_t unknown_bytes_ = 0;
  int unknown_count_ = 0;
  Counters counters_;
};

}  // namespace isobar::vn100

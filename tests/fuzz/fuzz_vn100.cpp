// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: the byte stream of a VN-100, in pieces whose length the first byte gives. A message must be within
// what was received.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "drivers/vn100/measurement.hpp"
#include "drivers/vn100/protocol.hpp"
#include "drivers/vn100/stream_parser.hpp"
#include "drivers/vn100/text_measurement.hpp"

namespace {

using namespace isobar;

/// Reads a stream in pieces.
void read_messages(std::span<const std::uint8_t> stream, std::size_t piece) {
  vn100::StreamParser parser;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    const std::size_t count = std::min(piece, stream.size() - at);
    const auto room = parser.room();
    if (room.size() < count) std::abort();
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), count, room.begin());
    parser.filled(count);
    if (at + count == stream.size()) parser.give_up_incomplete();
    for (auto frame = parser.next(); frame.kind != vn100::Frame::Kind::kNone; frame = parser.next()) {
      if (frame.bytes.empty() || frame.bytes_on_line < frame.bytes.size()) std::abort();
      if (frame.kind == vn100::Frame::Kind::kBinary) (void)vn100::read_packet(frame.bytes);
      if (frame.kind == vn100::Frame::Kind::kText) (void)vn100::read_text(frame.text());
    }
  }
}

void feed_protocol(std::span<const std::uint8_t> stream, bool configure) {
  vn100::Settings settings;
  settings.configure = configure;
  vn100::Protocol protocol(settings);
  protocol.restart();
  for (std::size_t at = 0; at < stream.size(); at += 64) {
    const std::size_t count = std::min<std::size_t>(64, stream.size() - at);
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), count, protocol.room().begin());
    protocol.filled(count);
    while (protocol.next().kind != serial::ImuEvent::Kind::kNone) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2 || size > 16'384) return 0;
  const std::span<const std::uint8_t> stream(data + 1, size - 1);
  feed_protocol(stream, true);
  feed_protocol(stream, false);
  read_messages(stream, std::size_t{1} + data[0]);
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "drivers/xsens/stream_parser.hpp"
#include "tests/drivers/xsens/message_writer.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_xsens_stream {

using namespace xsens;
using Bytes = std::vector<std::uint8_t>;

namespace {

void feed(StreamParser& parser, std::span<const std::uint8_t> bytes) {
  const auto room = parser.room();
  REQUIRE(room.size() >= bytes.size());
  std::copy(bytes.begin(), bytes.end(), room.begin());
  parser.filled(bytes.size());
}

/// All MTData2 of a stream that is received in pieces of `piece` bytes.
std::vector<Bytes> messages_of(const Bytes& stream, std::size_t piece) {
  StreamParser parser;
  std::vector<Bytes> messages;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    const std::size_t count = std::min(piece, stream.size() - at);
    feed(parser, std::span(stream).subspan(at, count));
    if (at + count == stream.size()) parser.give_up_incomplete();
    for (Frame frame = parser.next(); frame.found; frame = parser.next()) {
      if (frame.id == Id::kData) messages.emplace_back(frame.bytes.begin(), frame.bytes.end());
    }
  }
  return messages;
}

void append(Bytes& stream, const Bytes& more) { stream.insert(stream.end(), more.begin(), more.end()); }

}  // namespace

TEST_CASE("messages among others, false preambles and garbage are found whatever the pieces") {
  Bytes stream;
  std::vector<Bytes> sent;
  std::mt19937 random(5);
  for (std::uint16_t i = 0; i < 60; ++i) {
    const bool large = i % 7 == 3;
    const Bytes message =
        large ? MessageWriter().item(0x7010, Bytes(250, 0xFA)).item(0x7020, Bytes(100, 0xFF)).finish()
              : own_message(i, 100U * i);
    switch (i % 5) {
      case 0:
        append(stream, Bytes{0xFA, 0xFF, 0x36, 0xFF, 0x07, 0xFF});  // claims two kilobytes
        break;
      case 1:
        append(stream, make_message(Id::kGoToConfigAck, {}));
        break;
      case 2:
        append(stream, Bytes{0xFA, 0xFA, 0xFF, 0x36, 0x20});
        break;
      case 3:
        for (int n = 0; n < 40; ++n) stream.push_back(static_cast<std::uint8_t>(random()));
        break;
      default:
        append(stream, Bytes{0xFA, 0xFF, 0x55, 0x40});  // an id that is not used here
    }
    append(stream, message);
    sent.push_back(message);
  }
  for (const std::size_t piece : {1, 2, 3, 7, 44, 64, 311, 1000}) {
    INFO(piece);
    CHECK(messages_of(stream, piece) == sent);
  }
}

TEST_CASE("a cut at any byte costs the cut message and no other") {
  const Bytes first = own_message(1, 100);
  const Bytes second = own_message(2, 200);
  for (std::size_t cut = 1; cut < first.size(); ++cut) {
    Bytes stream(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(cut));
    append(stream, second);
    CHECK(messages_of(stream, stream.size()) == std::vector<Bytes>{second});
    stream.assign(first.begin() + static_cast<std::ptrdiff_t>(cut), first.end());
    append(stream, second);
    CHECK(messages_of(stream, stream.size()) == std::vector<Bytes>{second});
  }
}

TEST_CASE("a damaged byte costs its message and no other") {
  const Bytes message = own_message(1, 100);
  for (std::size_t at = 0; at < message.size(); ++at) {
    Bytes stream = message;
    Bytes damaged = message;
    damaged[at] ^= 0x10U;
    append(stream, damaged);
    append(stream, message);
    CHECK(messages_of(stream, 16) == std::vector<Bytes>{message, message});
  }
}

TEST_CASE("a false preamble that claims two kilobytes does not delay the data behind it") {
  StreamParser parser;
  feed(parser, Bytes{0xFA, 0xFF, 0x36, 0xFF, 0x07, 0xFF});
  CHECK_FALSE(parser.next().found);
  feed(parser, own_message(2, 200));
  CHECK(parser.next().found);
}

TEST_CASE("a message whose checksum holds by chance is none when its items do not fill it") {
  StreamParser parser;
  Bytes message = own_message(2, 200);
  message[6] += 2;  // the first item claims two bytes more
  message.back() -= 2;
  feed(parser, message);
  parser.give_up_incomplete();
  CHECK_FALSE(parser.next().found);
}

TEST_CASE("the extended length is read, also where it is not needed") {
  StreamParser parser;
  const Bytes message = MessageWriter().integer(0x1020, 7, 2).finish(true);
  feed(parser, message);
  const Frame frame = parser.next();
  REQUIRE(frame.found);
  CHECK(frame.bytes.size() == message.size());
  CHECK(frame.data.size() == 5);
}

TEST_CASE("random bytes yield no data and leave the parser free for the next message") {
  std::mt19937 random(12);
  StreamParser parser;
  const std::size_t allocations = allocation_count();
  std::size_t data_messages = 0;
  for (int round = 0; round < 400; ++round) {
    const auto room = parser.room();
    REQUIRE(room.size() >= 512);
    for (std::size_t i = 0; i < 512; ++i) room[i] = static_cast<std::uint8_t>(random());
    parser.filled(512);
    for (Frame frame = parser.next(); frame.found; frame = parser.next()) {
      if (frame.id == Id::kData) ++data_messages;
    }
  }
  CHECK(allocation_count() == allocations);
  CHECK(data_messages == 0);
  parser.give_up_incomplete();
  while (parser.next().found) {
  }
  feed(parser, own_message(2, 200));
  CHECK(parser.next().found);
}

}  // namespace isobar::test::test_xsens_stream

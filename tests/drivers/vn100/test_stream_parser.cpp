// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "drivers/vn100/stream_parser.hpp"
#include "tests/drivers/vn100/packet_writer.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_stream_parser {

using namespace vn100;
using Bytes = std::vector<std::uint8_t>;

namespace {

void feed(StreamParser& parser, std::span<const std::uint8_t> bytes) {
  const auto room = parser.room();
  REQUIRE(room.size() >= bytes.size());
  std::copy(bytes.begin(), bytes.end(), room.begin());
  parser.filled(bytes.size());
}

/// All packets of a stream that is received in pieces of `piece` bytes.
std::vector<Bytes> packets_of(const Bytes& stream, std::size_t piece, bool ended) {
  StreamParser parser;
  std::vector<Bytes> packets;
  const auto collect = [&] {
    for (Frame frame = parser.next(); frame.kind != Frame::Kind::kNone; frame = parser.next()) {
      if (frame.kind == Frame::Kind::kBinary) packets.emplace_back(frame.bytes.begin(), frame.bytes.end());
    }
  };
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    feed(parser, std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
    collect();
  }
  if (ended) parser.give_up_incomplete();
  collect();
  return packets;
}

void append(Bytes& stream, const Bytes& more) { stream.insert(stream.end(), more.begin(), more.end()); }
void append(Bytes& stream, const std::string& text) { stream.insert(stream.end(), text.begin(), text.end()); }

}  // namespace

TEST_CASE("the checksum is CRC-16 with polynomial 0x1021 and start 0") {
  const std::string check = "123456789";  // the check value 0x31C3 of this CRC (XMODEM)
  CHECK(crc16(std::span(reinterpret_cast<const std::uint8_t*>(check.data()), check.size())) == 0x31C3);
}

TEST_CASE("packets among text, NMEA, false sync bytes and garbage are found whatever the pieces") {
  Bytes stream;
  std::vector<Bytes> sent;
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    const Bytes packet = own_packet(static_cast<std::uint64_t>(i) * 5'000'000);
    switch (i % 5) {
      case 0:
        append(stream, std::string("$GPRMC,000012.800,V,,,,,0.00,0.00,060180,,,N*49\r\n"));
        break;
      case 1:
        append(stream, Bytes{0xFA, 0x7F, 0xFF, 0x7F});  // the start of a packet with many fields
        break;
      case 2:
        append(stream, Bytes{0xFA, 0xFA, 0x05, 0x01});
        break;
      case 3:
        for (int n = 0; n < 40; ++n) stream.push_back(static_cast<std::uint8_t>(random()));
        break;
      default:
        append(stream, std::string("$VNYMR,1"));  // a line without an end
    }
    append(stream, packet);
    sent.push_back(packet);
  }
  for (const std::size_t piece : {1, 2, 3, 7, 48, 64, 311, 1000}) {
    INFO(piece);
    CHECK(packets_of(stream, piece, true) == sent);
  }
}

TEST_CASE("a cut at any byte costs the cut packet and no other") {
  const Bytes first = own_packet(1);
  const Bytes second = own_packet(2);
  for (std::size_t cut = 1; cut < first.size(); ++cut) {
    Bytes stream(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(cut));
    append(stream, second);
    CHECK(packets_of(stream, stream.size(), true) == std::vector<Bytes>{second});
    stream.assign(first.begin() + static_cast<std::ptrdiff_t>(cut), first.end());
    append(stream, second);
    CHECK(packets_of(stream, stream.size(), true) == std::vector<Bytes>{second});
  }
}

TEST_CASE("a damaged byte costs its packet and no other, and is counted") {
  const Bytes packet = own_packet(1);
  std::uint64_t corrupt = 0;
  for (std::size_t at = 0; at < packet.size(); ++at) {
    Bytes stream = packet;
    Bytes damaged = packet;
    damaged[at] ^= 0x10U;
    append(stream, damaged);
    append(stream, packet);
    CHECK(packets_of(stream, 16, true) == std::vector<Bytes>{packet, packet});
    StreamParser parser;
    feed(parser, stream);
    while (parser.next().kind != Frame::Kind::kNone) {
    }
    corrupt += parser.counters().corrupt;
  }
  CHECK(corrupt ==
        packet.size() - 6);  // damage to the header's six bytes makes it no packet of the known form
}

TEST_CASE("a false sync byte that claims a kilobyte does not delay packets of the known form") {
  StreamParser parser;
  feed(parser, own_packet(1));
  REQUIRE(parser.next().kind == Frame::Kind::kBinary);
  feed(parser,
       Bytes{0xFA, 0x7F, 0xFF, 0x7F, 0xFF, 0x03, 0xFF, 0x1F, 0xFF, 0x3F, 0xFF, 0x1F, 0xFF, 0x1F, 0xFF, 0x3F});
  CHECK(parser.next().kind == Frame::Kind::kNone);
  feed(parser, own_packet(2));
  const Frame frame = parser.next();
  REQUIRE(frame.kind == Frame::Kind::kBinary);
  CHECK(std::equal(frame.bytes.begin(), frame.bytes.end(), own_packet(2).begin()));
}

TEST_CASE("a message knows how many bytes came since its first one") {
  StreamParser parser;
  Bytes stream = own_packet(1);
  append(stream, own_packet(2));
  append(stream, Bytes{0xFA, 0x05});
  feed(parser, stream);
  CHECK(parser.next().bytes_on_line == 2 * own_packet(1).size() + 2);
  CHECK(parser.next().bytes_on_line == own_packet(1).size() + 2);
}

TEST_CASE("random bytes yield no packet and leave the parser free for the next one") {
  std::mt19937 random(11);
  StreamParser parser;
  const std::size_t allocations = allocation_count();
  std::uint64_t bytes = 0;
  for (int round = 0; round < 400; ++round) {
    const auto room = parser.room();
    REQUIRE(room.size() >= 512);
    for (std::size_t i = 0; i < 512; ++i) room[i] = static_cast<std::uint8_t>(random());
    parser.filled(512);
    bytes += 512;
    while (parser.next().kind != Frame::Kind::kNone) {
    }
  }
  CHECK(allocation_count() == allocations);
  // A false packet needs a CRC of 16 bits by chance: of 800 sync bytes, most without a known form.
  CHECK(parser.counters().packets == 0);
  CHECK(parser.counters().skipped > bytes - 4096);
  feed(parser, own_packet(3));
  parser.give_up_incomplete();
  CHECK(parser.next().kind == Frame::Kind::kBinary);
}

}  // namespace isobar::test::test_stream_parser

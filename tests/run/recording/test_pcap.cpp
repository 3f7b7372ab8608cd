// SPDX-License-Identifier: BSD-3-Clause
// Captures are built byte by byte, as other tools would write them.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/pcap_packets.hpp"
#include "run/recording/udp_frame.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_pcap {

using namespace isobar::recording;

namespace {

using test::Scratch;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kSeconds = 1'700'000'000;

struct PcapStyle {
  bool big_endian = false;
  bool nanoseconds = false;
  std::uint32_t link = 1;
};

class PcapText {
 public:
  explicit PcapText(const PcapStyle& style) : style_(style) {
    put(style.nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4);
    put(2, 2);
    put(4, 2);
    put(0, 4);
    put(0, 4);
    put(65'535, 4);
    put(style.link, 4);
  }
  void add(std::uint32_t seconds, std::uint32_t fraction, const Bytes& frame,
           std::size_t captured = 1'000'000) {
    const auto kept = static_cast<std::uint32_t>(std::min(captured, frame.size()));
    put(seconds, 4);
    put(fraction, 4);
    put(kept, 4);
    put(static_cast<std::uint32_t>(frame.size()), 4);
    text_.append(frame.begin(), frame.begin() + kept);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void put(std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const int shift = style_.big_endian ? 8 * (bytes - 1 - i) : 8 * i;
      text_.push_back(static_cast<char>(value >> shift));
    }
  }
  PcapStyle style_;
  std::string text_;
};

Bytes payload_of(std::size_t size, int seed) {
  Bytes payload(size);
  for (std::size_t i = 0; i < size; ++i) {
    payload[i] = static_cast<std::uint8_t>(i * 7 + static_cast<std::size_t>(seed));
  }
  return payload;
}

Bytes frame_of(const Bytes& payload, std::uint16_t port = 2'368) {
  Bytes frame;
  build_udp_frame(payload, port, 1, frame);
  return frame;
}

Bytes tagged(Bytes frame, std::initializer_list<std::uint16_t> tags) {
  for (const std::uint16_t tag : tags) {
    frame.insert(frame.begin() + 12,
                 {static_cast<std::uint8_t>(tag >> 8U), static_cast<std::uint8_t>(tag), 0, 42});
  }
  return frame;
}

/// IPv4 fragments of a whole frame; `units` of 8 bytes each.
std::vector<Bytes> fragments_of(const Bytes& frame, std::size_t units) {
  std::vector<Bytes> fragments;
  const std::size_t headers = 34;
  for (std::size_t at = headers; at < frame.size(); at += units * 8) {
    const std::size_t size = std::min(units * 8, frame.size() - at);
    Bytes part(frame.begin(), frame.begin() + headers);
    part.insert(part.end(), frame.begin() + static_cast<long>(at),
                frame.begin() + static_cast<long>(at + size));
    const std::size_t total = 20 + size;
    part[16] = static_cast<std::uint8_t>(total >> 8U);
    part[17] = static_cast<std::uint8_t>(total);
    const std::size_t offset = (at - headers) / 8;
    const bool more = at + size < frame.size();
    part[20] = static_cast<std::uint8_t>((more ? 0x20U : 0U) | offset >> 8U);
    part[21] = static_cast<std::uint8_t>(offset);
    fragments.push_back(part);
  }
  return fragments;
}

std::vector<StampedPacket> read_all(PcapPackets& packets) {
  std::vector<StampedPacket> all;
  StampedPacket packet;
  while (packets.next(packet)) {
    all.push_back(packet);
  }
  return all;
}

std::unique_ptr<PcapPackets> open(const Scratch& scratch, const std::string& text) {
  scratch.write("l.pcap", text);
  return std::make_unique<PcapPackets>(scratch.path() / "l.pcap", LidarPorts{2'368, 0}, StampGuardConfig{});
}

}  // namespace

TEST_CASE("Both byte orders and both time resolutions give the same payloads and the right stamps") {
  Scratch scratch;
  const Bytes payload = payload_of(1'206, 1);
  for (const bool big_endian : {false, true}) {
    for (const bool nanoseconds : {false, true}) {
      PcapText text({big_endian, nanoseconds, 1});
      text.add(kSeconds, nanoseconds ? 123'456'789 : 123'456, frame_of(payload));
      const auto packets = read_all(*open(scratch, text.text()));
      REQUIRE(packets.size() == 1);
      CHECK(packets[0].payload == payload);
      CHECK(packets[0].stamp_ns ==
            std::int64_t{kSeconds} * 1'000'000'000 + (nanoseconds ? 123'456'789 : 123'456'000));
    }
  }
}

TEST_CASE("VLAN tags (also stacked) and the other link types are decoded") {
  Scratch scratch;
  const Bytes payload = payload_of(512, 2);
  PcapText text({});
  text.add(kSeconds, 1, tagged(frame_of(payload), {0x8100}));
  text.add(kSeconds, 2, tagged(frame_of(payload), {0x8100, 0x88A8}));
  auto packets = read_all(*open(scratch, text.text()));
  REQUIRE(packets.size() == 2);
  CHECK(packets[0].payload == payload);
  CHECK(packets[1].payload == payload);

  Bytes frame = frame_of(payload);
  Bytes cooked(16, 0);
  cooked[14] = 0x08;
  cooked.insert(cooked.end(), frame.begin() + 14, frame.end());
  PcapText cooked_text({false, false, 113});
  cooked_text.add(kSeconds, 1, cooked);
  packets = read_all(*open(scratch, cooked_text.text()));
  REQUIRE(packets.size() == 1);
  CHECK(packets[0].payload == payload);

  CHECK_THROWS_WITH_AS(open(scratch, PcapText({false, false, 105}).text()), doctest::Contains("link type"),
                       DataError);
}

TEST_CASE("IP fragments are reassembled in any order; a missing one is counted") {
  Scratch scratch;
  const Bytes payload = payload_of(1'206, 3);
  auto fragments = fragments_of(frame_of(payload), 64);
  REQUIRE(fragments.size() == 3);
  std::reverse(fragments.begin(), fragments.end());
  PcapText text({});
  for (const Bytes& fragment : fragments) {
    text.add(kSeconds, 1, fragment);
  }
  auto packets = open(scratch, text.text());
  const auto all = read_all(*packets);
  REQUIRE(all.size() == 1);
  CHECK(all[0].payload == payload);
  CHECK(packets->extractor().reassembled() == 1);

  PcapText lossy({});
  for (std::uint8_t i = 0; i < 10; ++i) {
    auto parts = fragments_of(frame_of(payload), 64);
    parts[0][19] = i;  // another identification
    lossy.add(kSeconds, i, parts[0]);
  }
  packets = open(scratch, lossy.text());
  CHECK(read_all(*packets).empty());
  CHECK(packets->extractor().incomplete() == 6);  // four are still waiting
}

TEST_CASE("Packets of both ports of a lidar come in the order of the capture") {
  Scratch scratch;
  PcapText text({});
  for (std::uint32_t i = 0; i < 6; ++i) {
    text.add(kSeconds + i, 0,
             frame_of(payload_of(100, static_cast<int>(i)), static_cast<std::uint16_t>(7'502 + i % 3)));
  }
  scratch.write("l.pcap", text.text());
  PcapPackets packets(scratch.path() / "l.pcap", LidarPorts{7'502, 7'503}, StampGuardConfig{});
  const auto all = read_all(packets);
  REQUIRE(all.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(int{all[i].payload[0]} == static_cast<int>(i / 2 * 3 + i % 2));
  CHECK(packets.tallies().other_port.count == 2);
}

TEST_CASE("A datagram with the identification of one that lost fragments is not mixed with it") {
  Scratch scratch;
  const Bytes lost = payload_of(1'206, 5);
  const Bytes payload = payload_of(1'206, 6);
  for (const std::size_t kept : {0U, 1U, 2U}) {
    CAPTURE(kept);
    PcapText text({});
    const auto old_parts = fragments_of(frame_of(lost), 64);
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != kept) text.add(kSeconds, 1, old_parts[i]);
    }
    for (const Bytes& part : fragments_of(frame_of(payload), 64)) text.add(kSeconds + 88, 1, part);
    const auto packets = open(scratch, text.text());
    const auto all = read_all(*packets);
    REQUIRE(all.size() == 1);
    CHECK(all[0].payload == payload);
    CHECK(packets->extractor().incomplete() == 1);
  }
}

TEST_CASE("Overlapping and repeated fragments give the datagram once, of the bytes that came first") {
  Scratch scratch;
  const Bytes payload = payload_of(1'206, 7);
  PcapText text({});
  const auto parts = fragments_of(frame_of(payload), 64);
  const auto other = fragments_of(frame_of(payload_of(1'206, 8)), 100);  // its first ends within parts[1]
  text.add(kSeconds, 1, parts[0]);
  text.add(kSeconds, 2, parts[0]);
  text.add(kSeconds, 3, parts[1]);
  text.add(kSeconds, 4, other[0]);
  text.add(kSeconds, 5, parts[2]);
  const auto all = read_all(*open(scratch, text.text()));
  REQUIRE(all.size() == 1);
  CHECK(all[0].payload == payload);
}

TEST_CASE(
    "Of a captured datagram whose identification was used before, the later one's fragments are joined") {
  const auto file = std::filesystem::path(ISOBAR_SHARED_DATA) / "ouster" / "duplicate_id.pcap";
  if (!std::filesystem::exists(file)) {
    MESSAGE("skipped: " << file.string() << " is not on this machine");
    return;
  }
  PcapPackets packets(file, LidarPorts{34'636, 0}, StampGuardConfig{});
  const auto all = read_all(packets);
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].payload.size() == 8'448);
  // Bytes 2 and 3 are the number of the turn: 0x037C in the first, lost datagram, 0x06F2 in the second.
  CHECK(int{all[0].payload[2]} == 0xF2);
  CHECK(int{all[0].payload[3]} == 0x06);
  CHECK(packets.extractor().incomplete() == 1);
}

TEST_CASE("Other ports and protocols, broken lengths and truncated frames have separate counters") {
  Scratch scratch;
  const Bytes payload = payload_of(1'206, 4);
  PcapText text({});
  text.add(kSeconds, 1, frame_of(payload));
  text.add(kSeconds, 2, frame_of(payload, 8'308));
  Bytes arp = frame_of(payload);
  arp[13] = 0x06;
  text.add(kSeconds, 3, arp);
  Bytes tcp = frame_of(payload);
  tcp[23] = 6;
  text.add(kSeconds, 4, tcp);
  Bytes udp_too_long = frame_of(payload);
  udp_too_long[38] = 0xFF;
  text.add(kSeconds, 5, udp_too_long);
  Bytes header_too_long = frame_of(Bytes{});
  header_too_long[14] = 0x4F;
  text.add(kSeconds, 6, header_too_long);
  text.add(kSeconds, 7, Bytes(9, 0));
  text.add(kSeconds, 8, frame_of(payload), 100);
  text.add(kSeconds, 9, frame_of(payload));
  const auto packets = open(scratch, text.text());
  const auto all = read_all(*packets);
  REQUIRE(all.size() == 3);
  CHECK(all[0].payload == payload);
  CHECK(all[1].payload.size() == 100 - 42);
  CHECK(all[2].payload == payload);
  CHECK(packets->tallies().other_port.count == 1);
  CHECK(packets->tallies().other_protocol.count == 2);
  CHECK(packets->tallies().malformed.count == 3);
  CHECK(packets->tallies().cut.count == 1);
  CHECK(packets->tallies().malformed.first_message.find("frame 5") != std::string::npos);
}

TEST_CASE("A file that ends within a packet gives all packets before it and reports the truncation") {
  Scratch scratch;
  PcapText text({});
  for (std::uint32_t i = 0; i < 5; ++i) {
    text.add(kSeconds, i, frame_of(payload_of(1'206, static_cast<int>(i))));
  }
  const auto packets = open(scratch, text.text().substr(0, text.text().size() - 700));
  CHECK(read_all(*packets).size() == 4);
  CHECK(packets->tallies().file_truncated.count == 1);
  CHECK_THROWS_AS(open(scratch, text.text().substr(0, 10)), DataError);
  CHECK_THROWS_AS(open(scratch, ""), DataError);
}

TEST_CASE("No packet is dropped for its stamp; an absurd stamp is replaced by the last good one") {
  Scratch scratch;
  PcapText text({});
  for (std::uint32_t i = 0; i < 20; ++i) {
    text.add(i == 7    ? 2'000'000'000
             : i == 12 ? 5
                       : kSeconds + (i > 15 ? 100 : 0),
             i, frame_of(payload_of(100, static_cast<int>(i))));
  }
  const auto packets = open(scratch, text.text());
  const auto all = read_all(*packets);
  REQUIRE(all.size() == 20);
  for (std::uint32_t i = 0; i < 20; ++i) {
    CHECK(all[i].payload == payload_of(100, static_cast<int>(i)));
    const std::int64_t stamp_of = i == 7 ? 6 : i == 12 ? 11 : i;
    CHECK(all[i].stamp_ns == std::int64_t{kSeconds + (i > 15 ? 100 : 0)} * 1'000'000'000 + stamp_of * 1'000);
  }
  CHECK(packets->tallies().absurd_stamp.count == 2);
}

TEST_CASE("Written frames have valid checksums") {
  const Bytes frame = frame_of(payload_of(33, 5));
  // RFC 1071: the sum over a header with its checksum is all ones.
  CHECK(internet_checksum(internet_sum({frame.data() + 14, 20})) == 0);
  const std::span<const std::uint8_t> udp(frame.data() + 34, frame.size() - 34);
  const auto pseudo = internet_sum({frame.data() + 26, 8}, 17U + static_cast<std::uint32_t>(udp.size()));
  CHECK(internet_checksum(internet_sum(udp, pseudo)) == 0);
}

}  // namespace isobar::test::test_pcap

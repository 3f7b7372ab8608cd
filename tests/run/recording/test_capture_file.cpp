// SPDX-License-Identifier: BSD-3-Clause
// Captures of formats and link types that are not the recorder's own, built byte by byte.
#include <doctest/doctest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/pcap_packets.hpp"
#include "run/recording/udp_frame.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_capture_file {

using namespace isobar::recording;

namespace {

using test::Scratch;
using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kStampNs = 1'700'000'000'123'456'000;
constexpr std::size_t kEthernetBytes = 14;

/// Little- or big-endian bytes.
class Writer {
 public:
  explicit Writer(bool big_endian = false) : big_endian_(big_endian) {}
  Writer& put(std::uint64_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) {
      text_.push_back(static_cast<char>(value >> (8 * (big_endian_ ? bytes - 1 - k : k))));
    }
    return *this;
  }
  Writer& put(const std::string& bytes) {
    text_ += bytes;
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

std::string text_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// An Ethernet frame with a payload of 100 bytes.
std::string frame_for(std::uint16_t port = 2'368) {
  Bytes frame;
  build_udp_frame(Bytes(100, 7), port, 1, frame);
  return text_of(frame);
}

std::string ip_packet_for(std::uint16_t port = 2'368) { return frame_for(port).substr(kEthernetBytes); }

std::string pcap_header(std::uint32_t link) {
  return Writer().put(0xA1B23C4D, 4).put(2, 2).put(4, 2).put(0, 8).put(65'535, 4).put(link, 4).text();
}

std::string pcap_record(const std::string& frame) {
  return Writer()
      .put(kStampNs / 1'000'000'000, 4)
      .put(kStampNs % 1'000'000'000, 4)
      .put(frame.size(), 4)
      .put(frame.size(), 4)
      .put(frame)
      .text();
}

std::string block(std::uint32_t type, const Writer& body, bool big_endian) {
  const std::size_t padding = (4 - body.text().size() % 4) % 4;
  const std::size_t length = body.text().size() + padding + 12;
  Writer out(big_endian);
  return out.put(type, 4)
      .put(length, 4)
      .put(body.text())
      .put(std::string(padding, '\0'))
      .put(length, 4)
      .text();
}

std::string section(bool big_endian) {
  return block(0x0A0D0D0A,
               Writer(big_endian).put(0x1A2B3C4D, 4).put(1, 2).put(0, 2).put(~std::uint64_t{0}, 8),
               big_endian);
}

/// @param resolution if_tsresol; 0: none, microseconds
std::string interface(std::uint32_t link, std::uint32_t resolution, bool big_endian) {
  Writer body(big_endian);
  body.put(link, 2).put(0, 2).put(0, 4);
  if (resolution != 0) body.put(9, 2).put(1, 2).put(resolution, 1).put(0, 3).put(0, 4);
  return block(1, body, big_endian);
}

std::string packet(std::uint32_t interface_index, std::uint64_t units, const std::string& frame,
                   bool big_endian) {
  Writer body(big_endian);
  body.put(interface_index, 4).put(units >> 32U, 4).put(units & 0xFFFF'FFFFU, 4);
  body.put(frame.size(), 4).put(frame.size(), 4).put(frame);
  return block(6, body, big_endian);
}

/// Two interfaces, the second one "any" of Linux, with nanoseconds; and one with a link type that nobody knows.
std::string two_interfaces(bool big_endian) {
  const std::string cooked = std::string(14, '\0') + "\x08" + std::string(1, '\0') + ip_packet_for();
  return section(big_endian) + interface(1, 0, big_endian) + interface(113, 9, big_endian) +
         interface(105, 0, big_endian) + packet(0, kStampNs / 1'000, frame_for(), big_endian) +
         packet(1, kStampNs + 1, cooked, big_endian) + packet(2, 0, "?", big_endian);
}

struct Contents {
  std::vector<StampedPacket> packets;
  PcapPackets::Tallies tallies;
  std::string ports;
};

Contents read(const std::string& capture) {
  const Scratch scratch;
  scratch.write("l.pcap", capture);
  PcapPackets packets(scratch.path() / "l.pcap", LidarPorts{2'368, 0}, StampGuardConfig{});
  Contents contents;
  StampedPacket one;
  while (packets.next(one)) contents.packets.push_back(one);
  contents.tallies = packets.tallies();
  contents.ports = packets.ports_text("the recording");
  return contents;
}

bool says(const Tally& tally, const std::string& words) {
  return tally.first_message.find(words) != std::string::npos;
}

std::string gzip(const std::string& bytes) {
  const Scratch scratch;
  const std::string file = (scratch.path() / "z").string();
  gzFile_s* out = gzopen(file.c_str(), "wb");
  REQUIRE(gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size())) == static_cast<int>(bytes.size()));
  REQUIRE(gzclose(out) == Z_OK);
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("captures of loopback, raw IP and IPv4 give the payloads, of every number that these have") {
  const std::string family_of_host = std::string("\x02\0\0\0", 4);
  const std::string family_in_order = std::string("\0\0\0\x02", 4);
  const std::vector<std::pair<std::uint32_t, std::string>> links{{0, family_of_host + ip_packet_for()},
                                                                 {108, family_in_order + ip_packet_for()},
                                                                 {12, ip_packet_for()},
                                                                 {14, ip_packet_for()},
                                                                 {101, ip_packet_for()},
                                                                 {228, ip_packet_for()}};
  for (const auto& entry : links) {
    const auto& [link, frame] = entry;
    INFO(entry.first);
    const Contents contents = read(pcap_header(link) + pcap_record(frame));
    REQUIRE(contents.packets.size() == 1);
    CHECK(contents.packets[0].payload == Bytes(100, 7));
    CHECK(contents.packets[0].stamp_ns == kStampNs);
  }
  CHECK_THROWS_WITH_AS(read(pcap_header(229) + pcap_record("")), doctest::Contains("IPV6 only"), DataError);
}

TEST_CASE("pcapng with interfaces of different link types and resolutions is read, in either byte order") {
  for (const bool big_endian : {false, true}) {
    CAPTURE(big_endian);
    const Contents contents = read(two_interfaces(big_endian));
    REQUIRE(contents.packets.size() == 2);
    CHECK(contents.packets[0].stamp_ns == kStampNs);
    CHECK(contents.packets[1].stamp_ns == kStampNs + 1);
    CHECK(contents.packets[1].payload == Bytes(100, 7));
    CHECK(contents.tallies.other_link.count == 1);
    CHECK(says(contents.tallies.other_link, "frame 3: is of link type IEEE802_11"));
    CHECK(contents.tallies.file_truncated.count == 0);
  }
}

TEST_CASE("each section of a pcapng file has its own byte order and interfaces") {
  const Contents contents = read(two_interfaces(false) + section(true) + interface(228, 0, true) +
                                 packet(0, kStampNs / 1'000 + 1, ip_packet_for(), true));
  REQUIRE(contents.packets.size() == 3);
  CHECK(contents.packets[2].stamp_ns == kStampNs + 1'000);
}

TEST_CASE("a pcapng file that is cut or broken gives what was good, and the reason") {
  const std::string whole = two_interfaces(false);
  const std::size_t first = section(false).size() + interface(1, 0, false).size() +
                            interface(113, 9, false).size() + interface(105, 0, false).size() +
                            packet(0, 0, frame_for(), false).size();
  for (std::size_t size = 12; size < first; ++size) CHECK(read(whole.substr(0, size)).packets.empty());
  const Contents cut = read(whole.substr(0, first + 40));
  CHECK(cut.packets.size() == 1);
  CHECK(says(cut.tallies.file_truncated, "the file ends within a block"));
  CHECK(says(read(whole + packet(9, 0, "x", false)).tallies.file_truncated,
             "an interface that is not described"));
  CHECK(
      says(read(whole + std::string("\x06\0\0\0\x0D\0\0\0", 8)).tallies.file_truncated, "has the length 13"));
}

TEST_CASE("captures compressed with gzip are read like the others, and a cut one says so") {
  const std::string plain = pcap_header(1) + pcap_record(frame_for()) + pcap_record(frame_for());
  for (const std::string& capture : {plain, two_interfaces(false)}) {
    const std::string packed = gzip(capture);
    CHECK(read(packed).packets.size() == 2);
    CHECK(read(packed).tallies.file_truncated.count == 0);
    CHECK(says(read(packed.substr(0, packed.size() - 9)).tallies.file_truncated, "unexpected end of file"));
  }
}

TEST_CASE("a damaged pcap file is reported in libpcap's words") {
  const std::string one = pcap_header(1) + pcap_record(frame_for());
  const Contents cut = read(one + pcap_record(frame_for()).substr(0, 30));
  CHECK(cut.packets.size() == 1);
  CHECK(says(cut.tallies.file_truncated, "truncated dump file; tried to read"));
}

TEST_CASE("packets for other ports are told with their ports") {
  std::string capture = pcap_header(228);
  for (int i = 0; i < 75; ++i) capture += pcap_record(ip_packet_for(2'370));
  CHECK(read(capture).ports.find("l.pcap: 75 packets for port 2370, the recording says 2368") !=
        std::string::npos);
  capture += pcap_record(ip_packet_for(53));
  CHECK(read(capture).ports.find("75 packets for port 2370, 1 packet for port 53, the recording") !=
        std::string::npos);
  CHECK(read(pcap_header(228) + pcap_record(ip_packet_for())).ports.empty());
  PortsSeen many;
  for (int port = 1; port <= 100; ++port) many.add(static_cast<std::uint16_t>(port));
  CHECK(many.text().find("1 packet for port 16, 84 packets for other ports") != std::string::npos);
}

}  // namespace isobar::test::test_capture_file

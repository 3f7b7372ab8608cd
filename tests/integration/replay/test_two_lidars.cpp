// SPDX-License-Identifier: BSD-3-Clause
// A recording with two lidars on one port: one is used, both are named, and the configuration chooses.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_two_lidars {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

namespace {

constexpr std::size_t kPcapHeaderBytes = 24;
constexpr std::size_t kRecordHeaderBytes = 16;
constexpr std::size_t kSenderOffset =
    14 + 12 + 3;  // last byte of the IPv4 source, behind the Ethernet header

/// Gives every second frame the source 192.168.1.202.
void rename_every_second_sender(const std::filesystem::path& pcap) {
  std::string bytes = bytes_of(pcap);
  bool is_second = false;
  for (std::size_t at = kPcapHeaderBytes; at + kRecordHeaderBytes < bytes.size(); is_second = !is_second) {
    std::uint32_t length = 0;
    bytes.copy(reinterpret_cast<char*>(&length), sizeof length, at + 8);
    if (is_second) bytes[at + kRecordHeaderBytes + kSenderOffset] = static_cast<char>(202);
    at += kRecordHeaderBytes + length;
  }
  std::ofstream(pcap, std::ios::binary) << bytes;
}

/// The short drive, and between its packets those of a lidar that looks elsewhere and has another clock.
std::filesystem::path with_second_lidar(const std::string& name, const std::string& sender) {
  const auto folder = copy_with(
      short_drive(), name, [&](auto& manifest) { manifest.lidar->sender = sender; },
      [](const recording::Event& event, recording::RecordingWriter& writer) {
        std::vector<std::string> warnings;
        write_event(event, recording::read_manifest(short_drive(), warnings), writer);
        if (event.kind != recording::EventKind::kLidarPacket) return;
        std::vector<std::uint8_t> other(event.packet.begin(), event.packet.end());
        if (other.size() != 1206) return;
        for (std::size_t block = 0; block < 12; ++block) {
          const std::size_t at = 100 * block + 2;
          const std::uint32_t azimuth = (other[at] + 256U * other[at + 1] + 12'345U) % 36'000U;
          other[at] = static_cast<std::uint8_t>(azimuth % 256U);
          other[at + 1] = static_cast<std::uint8_t>(azimuth / 256U);
        }
        other[1200] = static_cast<std::uint8_t>(other[1200] + 128U);
        writer.add_packet(event.stamp_ns + 300'000, other);
      });
  rename_every_second_sender(folder / "lidar.pcap");
  return folder;
}

}  // namespace

TEST_CASE("Of two lidars on one port the first heard is used; the run names both") {
  std::filesystem::path out;
  const auto summary = run(with_second_lidar("two-lidars", ""), out);
  CHECK(std::any_of(summary.warnings.begin(), summary.warnings.end(), [](const std::string& warning) {
    return warning.starts_with(
        "packets of 192.168.1.201 and of 192.168.1.202 on UDP port 2368: those of "
        "192.168.1.201 are used");
  }));
  CHECK(summary.scans < 150);  // 14 s at 10 Hz
  CHECK(count_of(summary, "lidar packets of another sender") > 5'000);
  std::filesystem::path alone;
  run(short_drive(), alone);
  CHECK(bytes_of(out / "trajectory.tum") == bytes_of(alone / "trajectory.tum"));
}

TEST_CASE("lidar.sender in recording.toml chooses the lidar") {
  std::filesystem::path out;
  const auto summary = run(with_second_lidar("second-lidar", "192.168.1.202"), out);
  CHECK(summary.scans < 150);
  CHECK(summary.scans > 100);
  std::filesystem::path alone;
  run(short_drive(), alone);
  CHECK(bytes_of(out / "trajectory.tum") != bytes_of(alone / "trajectory.tum"));
}

}  // namespace isobar::test::test_two_lidars

// SPDX-License-Identifier: BSD-3-Clause
// Recordings that are written live: complete at every time, from an input log.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/record_session.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/run/recording/scratch.hpp"
#include "tests/support/message_of.hpp"

namespace isobar::test::test_record_session {

using namespace isobar::recording;
using test::Scratch;

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kMs = 1'000'000;

Manifest robot_manifest(double lidar_height_m = 0.45) {
  Manifest manifest = Manifest::with_all_sensors();
  manifest.lidar->port = 2'368;
  manifest.lidar->mount.xyz_m = {0.1, 0.0, lidar_height_m};
  manifest.base_barometer->robot_clock = true;
  manifest.reference.reset();
  return manifest;
}

LogEntry description(const std::string& manifest, std::int64_t clock_offset_ns = 0) {
  LogEntry entry;
  entry.kind = LogKind::kDescription;
  entry.robot_clock_offset_ns = clock_offset_ns;
  entry.manifest = manifest;
  entry.settings = "method = \"3dof\"\n";
  return entry;
}

LogEntry imu(int i, bool has_attitude = false) {
  LogEntry entry;
  entry.kind = LogKind::kImu;
  entry.imu.stamp_ns = kStart + i * 5 * kMs;
  entry.imu.accel_m_s2 = {0.0, 0.0, 9.81};
  entry.imu.has_attitude = has_attitude;
  return entry;
}

LogEntry base(int i, std::uint8_t station, double variance_pa2) {
  LogEntry entry;
  entry.kind = LogKind::kBasePressure;
  entry.pressure = {kStart + i * 50 * kMs, 101'000.0 + station, 20.0, variance_pa2, station};
  return entry;
}

LogEntry packet(int i, std::span<const std::uint8_t> bytes) {
  LogEntry entry;
  entry.kind = LogKind::kPacket;
  entry.stamp_ns = kStart + i * 2 * kMs;
  entry.sender_ipv4 = 0x0A00'0007;
  entry.packet = bytes;
  return entry;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<Event> events_of(const std::filesystem::path& folder) {
  RecordingReader reader(folder);
  std::vector<Event> events;
  for (Event event; reader.next(event);) events.push_back(event);
  return events;
}

}  // namespace

TEST_CASE("the manifest of a live recording names the sensors that have delivered, after every flush") {
  Scratch scratch;
  const std::string manifest = manifest_text(robot_manifest());
  const std::filesystem::path folder = scratch.path() / "live";
  RecordSession session(folder);
  session.add(description(manifest));
  session.add(imu(0));
  session.flush();
  std::vector<std::string> warnings;
  Manifest seen = read_manifest(folder, warnings);
  CHECK(seen.imu);
  CHECK_FALSE(seen.lidar);
  CHECK_FALSE(seen.wheel);
  const std::vector<std::uint8_t> bytes(1'206, 7);
  session.add(packet(0, bytes));
  session.flush();
  seen = read_manifest(folder, warnings);
  REQUIRE(seen.lidar);
  CHECK(seen.lidar->mount.xyz_m.z() == 0.45);
  CHECK(warnings.empty());
  CHECK(events_of(folder).size() == 2);  // before close(): as after kill -9
  session.close();
  CHECK_FALSE(std::filesystem::exists(folder / "wheel.csv"));
  CHECK(text_of(folder / "settings.toml") == "method = \"3dof\"\n");
  CHECK(session.counts().packets == 1);
  CHECK(session.counts().imu == 1);
}

TEST_CASE("a live recording keeps variance and station of pressures and the sender of packets") {
  Scratch scratch;
  const std::string manifest = manifest_text(robot_manifest());
  const std::filesystem::path folder = scratch.path() / "live";
  RecordSession session(folder);
  session.add(description(manifest));
  session.add(base(0, 0, 0.25));
  session.add(base(1, 1, std::numeric_limits<double>::quiet_NaN()));
  const std::vector<std::uint8_t> bytes(1'206, 7);
  session.add(packet(0, bytes));
  session.close();
  const auto events = events_of(folder);
  REQUIRE(events.size() == 3);
  CHECK(events[0].pressure.variance_pa2 == 0.25);
  CHECK(events[0].pressure.station == 0);
  CHECK(std::isnan(events[2].pressure.variance_pa2));
  CHECK(events[2].pressure.station == 1);
  CHECK(events[2].stamp_ns == kStart + 50 * kMs);
  constexpr std::size_t kSourceAddress = 24 + 16 + 14 + 12;  // file, record, Ethernet, IPv4 up to it
  CHECK(text_of(folder / "lidar.pcap").substr(kSourceAddress, 4) == std::string("\x0A\x00\x00\x07", 4));
}

TEST_CASE("an IMU that computes its attitude only later keeps it from then on, and has none before") {
  Scratch scratch;
  const std::string manifest = manifest_text(robot_manifest());
  RecordSession session(scratch.path() / "live");
  session.add(description(manifest));
  session.add(imu(0, false));
  session.add(imu(1, true));
  session.close();
  const auto events = events_of(scratch.path() / "live");
  REQUIRE(events.size() == 2);
  CHECK_FALSE(events[0].imu.has_attitude);
  CHECK(events[1].imu.has_attitude);
}

TEST_CASE("base-station stamps that are on the robot's clock already are not shifted") {
  Scratch scratch;
  const std::string manifest = manifest_text(robot_manifest());
  RecordSession session(scratch.path() / "live");
  session.add(description(manifest));
  // Both files one second long, the base station's 0.7 s later: without the mark a reader takes that for an
  // offset of its clock.
  for (int i = 0; i <= 20; ++i) {
    LogEntry robot = base(i, 0, 0.25);
    robot.kind = LogKind::kPressure;
    session.add(robot);
    session.add(base(i + 14, 0, 0.25));
  }
  session.close();
  RecordingReader reader(scratch.path() / "live");
  CHECK(reader.base_clock().offset_ns == 0);
}

TEST_CASE(
    "the same sensors after a restart continue the folder; other mounts or a set clock begin a new one") {
  Scratch scratch;
  const std::string manifest = manifest_text(robot_manifest());
  const std::string moved = manifest_text(robot_manifest(0.6));
  const std::filesystem::path folder = scratch.path() / "live";
  RecordSession session(folder);
  session.add(description(manifest, 1'000));
  session.add(imu(0));
  session.add(description(manifest, 2'000));
  session.add(imu(1));
  CHECK(session.folders() == std::vector<std::filesystem::path>{folder});
  session.add(description(moved, 2'000));
  session.add(imu(2));
  session.add(description(moved, 3'600'000 * kMs));
  session.add(imu(3));
  session.close();
  REQUIRE(session.folders().size() == 3);
  CHECK(events_of(folder).size() == 2);
  CHECK(events_of(scratch.path() / "live-2").size() == 1);
  CHECK(events_of(scratch.path() / "live-3").size() == 1);
  CHECK(session.counts().imu == 4);
}

TEST_CASE("losses count on over several attachments to isobard") {
  Scratch scratch;
  RecordSession session(scratch.path() / "live");
  LogEntry losses;
  losses.kind = LogKind::kLosses;
  losses.losses = 5;
  session.begin_attachment();
  session.add(losses);
  session.begin_attachment();
  losses.losses = 2;
  session.add(losses);
  CHECK(session.lost() == 7);
}

TEST_CASE("a folder that holds anything is never written to") {
  Scratch scratch;
  scratch.write("note.txt", "mine");
  const std::string manifest = manifest_text(robot_manifest());
  RecordSession session(scratch.path());
  CHECK(message_of([&] { session.add(description(manifest)); }).find("exists already") != std::string::npos);
  CHECK(text_of(scratch.path() / "note.txt") == "mine");
  CHECK_FALSE(std::filesystem::exists(scratch.path() / kManifestFile));
}

TEST_CASE("scans of a lidar that gives clouds are recorded as clouds; one with a missing part is left out") {
  const Scratch scratch;
  Manifest manifest = robot_manifest();
  manifest.lidar->model = kCloudModel;
  manifest.lidar->file = "lidar.clouds";
  const auto scan = std::make_unique<Scan>();
  InputLog log;
  for (int i = 0; i < 3; ++i) {
    scan->stamp_ns = kStart + i * 100 * kMs;
    scan->point_count = 20'000;  // three records
    for (std::uint32_t k = 0; k < scan->point_count; ++k) {
      scan->points[k] = {1.0F + static_cast<float>(k),      2.0F, 3.0F, static_cast<std::uint16_t>(k),
                         static_cast<std::uint8_t>(k % 16), 7};
    }
    log.add_scan(*scan);
  }
  RecordSession session(scratch.path() / "r");
  session.add(description(manifest_text(manifest)));
  InputLogReader reader(log.bytes());
  LogEntry entry;
  for (int i = 0; reader.next(entry); ++i) {
    if (i != 4) session.add(entry);  // the middle of the second scan
  }
  CHECK(session.counts().clouds == 2);
  session.close();
  RecordingReader recording(scratch.path() / "r");
  std::vector<std::int64_t> stamps;
  Event event;
  while (recording.next(event)) {
    REQUIRE(event.kind == EventKind::kCloud);
    stamps.push_back(event.stamp_ns);
    CHECK(event.cloud->width == 20'000);
    float x_m = 0.0F;
    std::memcpy(&x_m, &event.cloud->data[std::size_t{19'999} * event.cloud->point_step], sizeof x_m);
    CHECK(x_m == 20'000.0F);
  }
  CHECK(stamps == std::vector<std::int64_t>{kStart, kStart + 200 * kMs});
}

}  // namespace isobar::test::test_record_session

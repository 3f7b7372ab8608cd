// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <fstream>

#include "core/errors.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/recording_writer.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_cloud_file {
namespace {

using namespace recording;

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

/// Cloud `index` of three points; with a clock that is 5 s behind the robot's.
CloudRecord some_cloud(std::size_t index) {
  CloudRecord cloud;
  cloud.stamp_ns = kStartNs + static_cast<std::int64_t>(index) * 100'000'000;
  cloud.shift_ns = 5'000'000'000;
  cloud.width = 3;
  cloud.height = 1;
  cloud.point_step = 8;
  cloud.row_step = 24;
  cloud.fields = {{"x", 0, 7}, {"offset_time", 4, 6}};
  for (std::size_t i = 0; i < 24; ++i) cloud.data.push_back(static_cast<std::uint8_t>(index * 31 + i));
  return cloud;
}

Manifest clouds_only() {
  Manifest manifest;
  manifest.lidar = LidarEntry{};
  manifest.lidar->model = kCloudModel;
  manifest.lidar->file = "lidar.clouds";
  manifest.lidar->mount.xyz_m = {0.1, 0.0, 0.4};
  return manifest;
}

void write_recording(const std::filesystem::path& folder, std::size_t clouds) {
  RecordingWriter writer(folder, clouds_only());
  for (std::size_t i = 0; i < clouds; ++i) REQUIRE(writer.add_cloud(some_cloud(i)));
  writer.close();
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("clouds of a recording come back bit by bit, on the robot's clock, with their mount") {
  const TemporaryFolder folder;
  write_recording(folder.path() / "r", 4);
  RecordingReader reader(folder.path() / "r");
  CHECK(reader.manifest().lidar->holds_clouds());
  CHECK(reader.manifest().lidar->mount.xyz_m.z() == 0.4);
  Event event;
  std::size_t read = 0;
  for (; reader.next(event); ++read) {
    REQUIRE(event.kind == EventKind::kCloud);
    const CloudRecord expected = some_cloud(read);
    CHECK(event.stamp_ns == expected.stamp_ns + expected.shift_ns);
    CHECK(event.cloud->stamp_ns == expected.stamp_ns);
    CHECK(event.cloud->shift_ns == expected.shift_ns);
    CHECK(event.cloud->width == 3);
    CHECK(event.cloud->point_step == 8);
    CHECK(event.cloud->row_step == 24);
    REQUIRE(event.cloud->fields.size() == 2);
    CHECK(event.cloud->fields[1].name == "offset_time");
    CHECK(event.cloud->fields[1].offset == 4);
    CHECK(event.cloud->fields[1].datatype == 6);
    CHECK(event.cloud->data == expected.data);
  }
  CHECK(read == 4);
  CHECK(reader.progress() == 1.0);
}

TEST_CASE("a file of clouds that is cut gives every whole cloud and says where it ends") {
  const TemporaryFolder folder;
  write_recording(folder.path() / "r", 4);
  const std::string whole = bytes_of(folder.path() / "r" / "lidar.clouds");
  for (std::size_t cut = 13; cut < whole.size(); cut += 11) {
    std::ofstream(folder.path() / "cut", std::ios::binary) << whole.substr(0, cut);
    CloudFileReader reader(folder.path() / "cut");
    CloudRecord cloud;
    std::size_t read = 0;
    while (reader.next(cloud)) CHECK(cloud.data == some_cloud(read++).data);
    CHECK(read < 4);
    CHECK(reader.tallies().truncated.first_message.find("cut: cloud " + std::to_string(read + 1)) !=
          std::string::npos);
  }
}

TEST_CASE("a cloud whose check sum is wrong is left out, and those behind it are read") {
  const TemporaryFolder folder;
  write_recording(folder.path() / "r", 4);
  std::string bytes = bytes_of(folder.path() / "r" / "lidar.clouds");
  bytes[12 + 40] = static_cast<char>(bytes[12 + 40] ^ 1);
  std::ofstream(folder.path() / "r" / "lidar.clouds", std::ios::binary) << bytes;
  RecordingReader reader(folder.path() / "r");
  Event event;
  std::size_t read = 0;
  while (reader.next(event)) ++read;
  CHECK(read == 3);
  bool is_said = false;
  for (const Count& count : reader.counts()) is_said = is_said || count.name == "lidar: damaged clouds";
  CHECK(is_said);
}

TEST_CASE("another file, or one of a later version, is refused with its name") {
  const TemporaryFolder folder;
  write_recording(folder.path() / "r", 1);
  std::string bytes = bytes_of(folder.path() / "r" / "lidar.clouds");
  bytes[8] = 2;
  std::ofstream(folder.path() / "later", std::ios::binary) << bytes;
  std::ofstream(folder.path() / "other", std::ios::binary) << "t_ns,x";
  CHECK(message_of([&] { CloudFileReader(folder.path() / "later"); }).find("later: is of version 2") !=
        std::string::npos);
  CHECK(message_of([&] { CloudFileReader(folder.path() / "other"); }).find("other: is no file of clouds") !=
        std::string::npos);
}

}  // namespace isobar::test::test_cloud_file

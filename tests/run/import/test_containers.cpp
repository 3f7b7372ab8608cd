// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/errors.hpp"
#include "run/import/bag_folder.hpp"
#include "run/import/message_stream.hpp"
#include "tests/run/import/bag_builder.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_containers {
namespace {

const std::vector<BagTopic> kTopics{{"/imu", "sensor_msgs/msg/Imu"},
                                    {"/points", "sensor_msgs/msg/PointCloud2"}};

/// Five messages of two topics, of lengths from 0 to more than a step of the decompression.
std::vector<BagMessage> some_messages() {
  std::vector<BagMessage> messages;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::size_t length = i == 3 ? 3'000'000 : 7 * i + 1;
    messages.push_back({i % 2, 1'700'000'000'000'000'001 + static_cast<std::int64_t>(i),
                        std::string(length, static_cast<char>('a' + i))});
  }
  return messages;
}

/// Reads a container and compares all that it gives.
void check_reads_back(const std::filesystem::path& source, imports::Encoding encoding) {
  const auto stream = imports::open_messages(source);
  imports::Message message;
  const std::vector<BagMessage> written = some_messages();
  std::size_t read = 0;
  while (stream->next(message)) {
    REQUIRE(read < written.size());
    const BagMessage& expected = written[read++];
    CHECK(message.log_ns == expected.log_ns);
    CHECK(stream->channels().at(message.channel).topic == kTopics[expected.topic].topic);
    CHECK(stream->channels().at(message.channel).type ==
          (expected.topic == 0 ? "sensor_msgs/Imu" : "sensor_msgs/PointCloud2"));
    CHECK(stream->channels().at(message.channel).encoding == encoding);
    CHECK(std::string(message.bytes.begin(), message.bytes.end()) == expected.bytes);
  }
  CHECK(read == written.size());
  CHECK(stream->damage().count == 0);
  CHECK(stream->progress() == doctest::Approx(1.0).epsilon(0.2));
}

}  // namespace

TEST_CASE("an MCAP gives every message as it was written, with each compression and without chunks") {
  const TemporaryFolder folder;
  for (const std::string method : {"none", "", "lz4", "zstd"}) {
    CAPTURE(method);
    write_bytes(folder.path() / "a.mcap", mcap_file(kTopics, some_messages(), method));
    check_reads_back(folder.path() / "a.mcap", imports::Encoding::kCdr);
  }
}

TEST_CASE("a ROS 1 bag gives every message as it was written, with each compression") {
  const TemporaryFolder folder;
  for (const std::string method : {"none", "lz4", "bz2"}) {
    CAPTURE(method);
    write_bytes(folder.path() / "a.bag", rosbag1_file(kTopics, some_messages(), method));
    check_reads_back(folder.path() / "a.bag", imports::Encoding::kRos1);
  }
}

TEST_CASE("a rosbag2 is read from its .db3, and from its folder with or without metadata") {
  const TemporaryFolder folder;
  write_db3(folder.path() / "a b?_0.db3", kTopics, some_messages());
  check_reads_back(folder.path() / "a b?_0.db3", imports::Encoding::kCdr);
  check_reads_back(folder.path(), imports::Encoding::kCdr);
  write_bytes(
      folder.path() / "metadata.yaml",
      "rosbag2_bagfile_information:\n  relative_file_paths:\n    - gone.db3\n  compression_mode: \"\"\n");
  check_reads_back(folder.path(), imports::Encoding::kCdr);
}

TEST_CASE("the files of a divided rosbag2 follow each other, and a topic keeps its number") {
  const TemporaryFolder folder;
  const std::vector<BagMessage> all = some_messages();
  // The second file knows the topics in the other order.
  write_bytes(folder.path() / "bag_9.mcap", mcap_file(kTopics, {all[0], all[1]}, "zstd"));
  std::vector<BagMessage> rest(all.begin() + 2, all.end());
  for (BagMessage& message : rest) message.topic = 1 - message.topic;
  write_bytes(folder.path() / "bag_10.mcap", mcap_file({kTopics[1], kTopics[0]}, rest, ""));
  check_reads_back(folder.path(), imports::Encoding::kCdr);
}

TEST_CASE("parts of a ROS 1 bag follow each other by their numbers; several bags are not mixed") {
  const TemporaryFolder folder;
  const std::vector<BagMessage> all = some_messages();
  // rosbag record --split names each part by its time and its number; the clock was set back between them.
  write_bytes(folder.path() / "run_2026-11-30-08-05-00_1.bag",
              rosbag1_file(kTopics, {all.begin() + 2, all.end()}, "bz2"));
  write_bytes(folder.path() / "run_2026-11-30-09-00-00_0.bag",
              rosbag1_file(kTopics, {all[0], all[1]}, "lz4"));
  check_reads_back(folder.path(), imports::Encoding::kRos1);
  write_bytes(folder.path() / "other.bag", rosbag1_file(kTopics, all, "none"));
  const std::string refusal = message_of([&] { (void)imports::open_messages(folder.path()); });
  CHECK(refusal.find("holds several bags: ") != std::string::npos);
  CHECK(refusal.find("other.bag") != std::string::npos);
  CHECK(imports::part_number("a_12.db3.zstd") == 12);
  CHECK_FALSE(imports::part_number("a12.db3"));
  write_bytes(folder.path() / "n_0.bag", "");
  write_bytes(folder.path() / "n_1.bag", "");
  CHECK(imports::next_part(folder.path() / "n_0.bag") == "n_1.bag");
  CHECK_FALSE(imports::next_part(folder.path() / "n_1.bag"));
}

TEST_CASE(
    "bags that are compressed as a whole are decompressed, and a cut one gives what is before the cut") {
  const TemporaryFolder folder;
  write_db3(folder.path() / "bag_0.db3", kTopics, some_messages());
  std::ifstream in(folder.path() / "bag_0.db3", std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  std::filesystem::remove(folder.path() / "bag_0.db3");
  const auto file = folder.path() / "bag_0.db3.zstd";
  write_bytes(file, compressed("zstd", whole));
  write_bytes(folder.path() / "metadata.yaml",
              "  compression_format: zstd\n  compression_mode: FILE\n  relative_file_paths:\n    - "
              "bag_0.db3.zstd\n");
  CHECK(imports::holds_messages(file));
  check_reads_back(file, imports::Encoding::kCdr);
  check_reads_back(folder.path(), imports::Encoding::kCdr);
  const std::string bag = compressed("zstd", rosbag1_file(kTopics, some_messages(), "none"));
  write_bytes(folder.path() / "cut.bag.zst", bag.substr(0, bag.size() - 8));
  const auto stream = imports::open_messages(folder.path() / "cut.bag.zst");
  imports::Message message;
  while (stream->next(message)) continue;
  CHECK(stream->damage().first_message.find("cut.bag.zst: byte ") != std::string::npos);
}

TEST_CASE("messages that rosbag2 compressed one by one are decompressed") {
  const TemporaryFolder folder;
  std::vector<BagMessage> messages = some_messages();
  for (BagMessage& message : messages) message.bytes = compressed("zstd", message.bytes);
  write_db3(folder.path() / "bag_0.db3", kTopics, messages);
  write_bytes(
      folder.path() / "metadata.yaml",
      "  compression_format: zstd\n  compression_mode: MESSAGE\n  relative_file_paths:\n    - bag_0.db3\n");
  check_reads_back(folder.path(), imports::Encoding::kCdr);
}

TEST_CASE("what is no container is refused with its name") {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "x.bag", "#ROSBAG V1.2\nrest");
  write_bytes(folder.path() / "y.bag", "anything");
  const auto refusal = [&](const char* name) {
    return message_of([&] { (void)imports::open_messages(folder.path() / name); });
  };
  CHECK(refusal("x.bag").find("x.bag: is no ROS 1 bag of version 2.0") != std::string::npos);
  CHECK(refusal("y.bag").find("y.bag: is no rosbag1, rosbag2 or MCAP") != std::string::npos);
  CHECK(refusal("gone").find("gone: is no rosbag1") != std::string::npos);
  CHECK(imports::holds_messages(folder.path() / "y.bag") == false);
  std::filesystem::create_directory(folder.path() / "folder");
  CHECK(imports::holds_messages(folder.path() / "folder") == false);
}

}  // namespace isobar::test::test_containers

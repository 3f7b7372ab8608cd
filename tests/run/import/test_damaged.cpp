// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "core/errors.hpp"
#include "run/import/decompress.hpp"
#include "run/import/mcap_stream.hpp"
#include "run/import/message_stream.hpp"
#include "tests/run/import/bag_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_damaged {
namespace {

const std::vector<BagTopic> kOneTopic{{"/imu", "sensor_msgs/Imu"}};

std::vector<BagMessage> numbered_messages(std::size_t count) {
  std::vector<BagMessage> messages;
  for (std::size_t i = 0; i < count; ++i) {
    messages.push_back({0, static_cast<std::int64_t>(i) + 1, "message " + std::to_string(i)});
  }
  return messages;
}

struct Found {
  std::vector<std::int64_t> stamps;
  std::string damage;
};

Found read_all(const std::filesystem::path& file) {
  Found found;
  const auto stream = imports::open_messages(file);
  imports::Message message;
  while (stream->next(message)) found.stamps.push_back(message.log_ns);
  found.damage = stream->damage().first_message;
  return found;
}

/// Whether the stamps are 1, 2, 3 …
bool is_a_beginning(const std::vector<std::int64_t>& stamps) {
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (stamps[i] != static_cast<std::int64_t>(i) + 1) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a bag that was cut gives all messages before the cut, and says where it ends") {
  const TemporaryFolder folder;
  const std::vector<BagMessage> messages = numbered_messages(20);
  for (const std::string& whole :
       {mcap_file(kOneTopic, messages, "lz4"), mcap_file(kOneTopic, messages, "none"),
        rosbag1_file(kOneTopic, messages, "bz2")}) {
    std::size_t before = 0;
    for (std::size_t cut = 20; cut < whole.size(); cut += 97) {
      write_bytes(folder.path() / "cut", whole.substr(0, cut));
      const Found found = read_all(folder.path() / "cut");
      CHECK(is_a_beginning(found.stamps));
      CHECK(found.stamps.size() >= before);  // a longer file gives no less
      before = found.stamps.size();
      if (found.stamps.size() < 18) CHECK(found.damage.find("cut: byte ") != std::string::npos);
    }
    CHECK(before >= 18);
  }
}

TEST_CASE("a chunk whose check sum is wrong is left out, and the chunks behind it are read") {
  const TemporaryFolder folder;
  std::string file = mcap_file(kOneTopic, numbered_messages(6), "");
  const std::size_t at = file.find("message 2");
  REQUIRE(at != std::string::npos);
  file[at + 8] = 'X';
  write_bytes(folder.path() / "a.mcap", file);
  const Found found = read_all(folder.path() / "a.mcap");
  CHECK(found.stamps == std::vector<std::int64_t>{1, 2, 5, 6});
  CHECK(found.damage.find("the check sum of a chunk is wrong") != std::string::npos);
}

TEST_CASE("a damaged compressed chunk of a ROS 1 bag costs that chunk only") {
  const TemporaryFolder folder;
  std::string file = rosbag1_file(kOneTopic, numbered_messages(6), "lz4");
  // The second chunk: behind the second name of the method.
  std::size_t at = file.find("compression=lz4");
  at = file.find("compression=lz4", at + 1);
  file[at + 60] = static_cast<char>(file[at + 60] ^ 0x55);
  write_bytes(folder.path() / "a.bag", file);
  const Found found = read_all(folder.path() / "a.bag");
  CHECK(found.stamps.front() == 1);
  CHECK(found.stamps.back() == 6);
  CHECK(found.stamps.size() >= 4);
  CHECK(found.damage.find("a.bag: byte ") != std::string::npos);
}

TEST_CASE("a database that was cut gives the messages before the cut") {
  const TemporaryFolder folder;
  std::vector<BagMessage> messages = numbered_messages(200);
  for (BagMessage& message : messages) message.bytes.resize(900, 'x');
  write_db3(folder.path() / "whole.db3", kOneTopic, messages);
  std::ifstream in(folder.path() / "whole.db3", std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  write_bytes(folder.path() / "cut.db3", whole.substr(0, whole.size() / 2));
  const Found found = read_all(folder.path() / "cut.db3");
  // SQLite reads the page across the cut as far as it is there, so that rows of it may be missing.
  CHECK(std::is_sorted(found.stamps.begin(), found.stamps.end()));
  CHECK(found.stamps.size() > 80);
  CHECK(found.stamps.size() < 120);
  CHECK(found.damage.find("cut.db3: ") != std::string::npos);
}

TEST_CASE("bytes that were changed at random never break a reader") {
  const TemporaryFolder folder;
  const std::vector<BagMessage> messages = numbered_messages(12);
  std::mt19937 random(7);
  for (const std::string& whole :
       {mcap_file(kOneTopic, messages, "zstd"), rosbag1_file(kOneTopic, messages, "none")}) {
    for (int round = 0; round < 60; ++round) {
      std::string file = whole;
      for (int i = 0; i < 4; ++i) file[13 + random() % (file.size() - 13)] = static_cast<char>(random());
      write_bytes(folder.path() / "changed", file);
      CHECK(read_all(folder.path() / "changed").stamps.size() <= 12);
    }
  }
}

TEST_CASE("a chunk within a chunk is left out, and what surrounds it is read") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "nested";
  const std::string schema =
      mcap_record(3, little(std::uint16_t{1}) + counted("a/B") + counted("") + counted(""));
  const std::string channel = mcap_record(
      4, little(std::uint16_t{1}) + little(std::uint16_t{1}) + counted("/a") + counted("cdr") + counted(""));
  const std::string message =
      mcap_record(5, little(std::uint16_t{1}) + little(std::uint32_t{0}) + std::string(16, '\0') + "bytes");
  const auto chunk = [](const std::string& content) {
    const std::string data = compressed("lz4", content);
    return mcap_record(6, std::string(16, '\0') + little(static_cast<std::uint64_t>(content.size())) +
                              little(std::uint32_t{0}) + counted("lz4") +
                              little(static_cast<std::uint64_t>(data.size())) + data);
  };
  write_bytes(file, std::string("\x89MCAP0\r\n", 8) + chunk(schema + channel + chunk(message) + message));
  imports::McapStream mcap(file);
  imports::Message read;
  REQUIRE(mcap.next(read));
  CHECK(std::string(read.bytes.begin(), read.bytes.end()) == "bytes");
  CHECK_FALSE(mcap.next(read));
  CHECK(mcap.damage().first_message.find("a chunk within a chunk") != std::string::npos);
}

TEST_CASE("decompression stops at the size that was stated") {
  const std::string zeros(5'000'000, '\0');
  std::vector<std::uint8_t> out;
  for (const char* method : {"lz4", "zstd", "bz2", "none"}) {
    const std::string bytes = compressed(method, zeros);
    const std::span from(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    REQUIRE(imports::decompress(method, from, 1'000'000, out) != nullptr);
    CHECK(out.size() <= 1'000'000);
    REQUIRE(imports::decompress(method, from, zeros.size(), out) == nullptr);
    CHECK(out.size() == zeros.size());
  }
  CHECK(imports::decompress("xz", {}, 10, out) != nullptr);
}

}  // namespace isobar::test::test_damaged

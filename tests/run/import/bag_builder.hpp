// SPDX-License-Identifier: BSD-3-Clause
// Writers of small bags for tests, by the published formats and without the readers' code.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace isobar::test {

struct BagTopic {
  std::string topic;
  std::string type;  // as the container says it
};

struct BagMessage {
  std::size_t topic = 0;
  std::int64_t log_ns = 0;
  std::string bytes;
};

template <typename Value>
std::string little(Value value) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  return bytes;
}
inline std::string counted(const std::string& text) {
  return little(static_cast<std::uint32_t>(text.size())) + text;
}

inline std::string compressed(const std::string& method, const std::string& from) {
  if (method.empty() || method == "none") return from;
  std::string to(from.size() * 2 + 4096, '\0');
  if (method == "lz4") {
    to.resize(LZ4F_compressFrame(to.data(), to.size(), from.data(), from.size(), nullptr));
  } else if (method == "zstd") {
    to.resize(ZSTD_compress(to.data(), to.size(), from.data(), from.size(), 3));
  } else if (method == "bz2") {
    auto size = static_cast<unsigned>(to.size());
    BZ2_bzBuffToBuffCompress(to.data(), &size, const_cast<char*>(from.data()),
                             static_cast<unsigned>(from.size()), 9, 0, 0);
    to.resize(size);
  }
  return to;
}

inline std::string mcap_record(std::uint8_t opcode, const std::string& content) {
  return static_cast<char>(opcode) + little(static_cast<std::uint64_t>(content.size())) + content;
}

/// An MCAP with two messages a chunk.
/// @param method "none": without chunks; "", "lz4", "zstd": of the chunks
inline std::string mcap_file(const std::vector<BagTopic>& topics, const std::vector<BagMessage>& messages,
                             const std::string& method, const std::string& encoding = "cdr") {
  const std::string magic("\x89MCAP0\r\n", 8);
  std::string described;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(i + 1);
    described += mcap_record(3, little(id) + counted(topics[i].type) + counted("ros2msg") + counted("text"));
    described +=
        mcap_record(4, little(id) + little(id) + counted(topics[i].topic) + counted(encoding) + counted(""));
  }
  std::string file = magic + mcap_record(1, counted("ros2") + counted("test"));
  std::string chunk = described;
  const auto close_chunk = [&] {
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const unsigned char*>(chunk.data()), static_cast<unsigned>(chunk.size())));
    const std::string data = compressed(method, chunk);
    file += mcap_record(6, little(std::uint64_t{0}) + little(std::uint64_t{0}) +
                               little(static_cast<std::uint64_t>(chunk.size())) + little(crc) +
                               counted(method) + little(static_cast<std::uint64_t>(data.size())) + data);
    chunk.clear();
  };
  if (method == "none") {
    file += chunk;
    chunk.clear();
  }
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto time = static_cast<std::uint64_t>(messages[i].log_ns);
    const std::string record =
        mcap_record(5, little(static_cast<std::uint16_t>(messages[i].topic + 1)) + little(std::uint32_t{0}) +
                           little(time) + little(time) + messages[i].bytes);
    (method == "none" ? file : chunk) += record;
    if (method != "none" && i % 2 == 1) close_chunk();
  }
  if (!chunk.empty()) close_chunk();
  return file + mcap_record(0x0f, little(std::uint32_t{0})) + mcap_record(2, std::string(20, '\0')) + magic;
}

inline std::string bag1_field(const std::string& name, const std::string& value) {
  return counted(name + "=" + value);
}
inline std::string bag1_record(const std::string& header, const std::string& data) {
  return counted(header) + counted(data);
}

/// A ROS 1 bag with two messages a chunk.
inline std::string rosbag1_file(const std::vector<BagTopic>& topics, const std::vector<BagMessage>& messages,
                                const std::string& method) {
  const std::string magic = "#ROSBAG V2.0\n";
  const auto head = [](std::uint64_t index_at) {
    return bag1_record(bag1_field("op", "\x03") + bag1_field("index_pos", little(index_at)),
                       std::string(4000, ' '));
  };
  std::string file;
  std::string chunk;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    chunk += bag1_record(
        bag1_field("op", "\x07") + bag1_field("conn", little(id)) + bag1_field("topic", topics[i].topic),
        bag1_field("topic", topics[i].topic) + bag1_field("type", topics[i].type) +
            bag1_field("message_definition", "text"));
  }
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(messages[i].topic);
    const auto seconds = static_cast<std::uint32_t>(messages[i].log_ns / 1'000'000'000);
    const auto nanoseconds = static_cast<std::uint32_t>(messages[i].log_ns % 1'000'000'000);
    chunk += bag1_record(bag1_field("op", "\x02") + bag1_field("conn", little(id)) +
                             bag1_field("time", little(seconds) + little(nanoseconds)),
                         messages[i].bytes);
    if (i % 2 == 0 && i + 1 < messages.size()) continue;
    file += bag1_record(bag1_field("op", "\x05") + bag1_field("compression", method) +
                            bag1_field("size", little(static_cast<std::uint32_t>(chunk.size()))),
                        compressed(method, chunk));
    chunk.clear();
  }
  const std::size_t before = magic.size() + head(0).size();
  return magic + head(before + file.size()) + file;
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// The SQLite file of a rosbag2.
inline void write_db3(const std::filesystem::path& file, const std::vector<BagTopic>& topics,
                      const std::vector<BagMessage>& messages) {
  sqlite3* base = nullptr;
  if (sqlite3_open(file.c_str(), &base) != SQLITE_OK) throw std::runtime_error("no database");
  const auto run = [base](const std::string& sql) {
    sqlite3_exec(base, sql.c_str(), nullptr, nullptr, nullptr);
  };
  run("PRAGMA synchronous=OFF");
  run("BEGIN; CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT,type TEXT,serialization_format TEXT);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER,timestamp INTEGER,data BLOB);");
  for (std::size_t i = 0; i < topics.size(); ++i) {
    run("INSERT INTO topics VALUES(" + std::to_string(i + 1) + ",'" + topics[i].topic + "','" +
        topics[i].type + "','cdr');");
  }
  sqlite3_stmt* row = nullptr;
  sqlite3_prepare_v2(base, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", -1, &row, nullptr);
  for (const BagMessage& message : messages) {
    sqlite3_bind_int64(row, 1, static_cast<std::int64_t>(message.topic) + 1);
    sqlite3_bind_int64(row, 2, message.log_ns);
    sqlite3_bind_blob(row, 3, message.bytes.data(), static_cast<int>(message.bytes.size()), SQLITE_TRANSIENT);
    sqlite3_step(row);
    sqlite3_reset(row);
  }
  sqlite3_finalize(row);
  run("COMMIT;");
  sqlite3_close(base);
}

}  // namespace isobar::test

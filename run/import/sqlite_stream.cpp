// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/sqlite_stream.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "run/import/decompress.hpp"
#include "run/import/file_bytes.hpp"

namespace isobar::imports {
namespace {

/// The path as an SQLite URI: characters with a meaning there as %XX.
std::string uri_of(const std::filesystem::path& file) {
  constexpr const char* kHex = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#') {
      uri += {'%', kHex[byte / 16], kHex[byte % 16]};
    } else {
      uri += c;
    }
  }
  // A recorder that was killed leaves its last messages in a log beside the file, which only an ordinary reader merges.
  std::error_code error;
  const bool has_log = std::filesystem::exists(file.string() + "-wal", error);
  return uri + (has_log ? "?mode=ro" : "?mode=ro&immutable=1");
}

std::string text_of(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr ? std::string()
                         : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

}  // namespace

void SqliteStream::Closer::operator()(sqlite3* base) const { sqlite3_close(base); }
void SqliteStream::Closer::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteStream::SqliteStream(const std::filesystem::path& file, std::string message_compression)
    : name_(file.string()), message_compression_(std::move(message_compression)) {
  sqlite3* base = nullptr;
  const int state =
      sqlite3_open_v2(uri_of(file).c_str(), &base, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  base_.reset(base);
  if (state != SQLITE_OK) throw DataError(name_ + ": cannot be opened: " + error_text());
  sqlite3_limit(base, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostRecordBytes));
  // SQLite refuses a file that is shorter than its header says, unless the schema may be written.
  sqlite3_exec(base, "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
  read_topics();
  read_definitions();
  messages_ = prepare("SELECT id, topic_id, timestamp, data FROM messages ORDER BY id");
  if (messages_ == nullptr) throw DataError(name_ + ": holds no messages of a rosbag2: " + error_text());
  if (const Statement last = prepare("SELECT max(id) FROM messages");
      last != nullptr && sqlite3_step(last.get()) == SQLITE_ROW) {
    last_id_ = sqlite3_column_int64(last.get(), 0);
  }
}

std::string SqliteStream::error_text() const { return sqlite3_errmsg(base_.get()); }

SqliteStream::Statement SqliteStream::prepare(const char* sql) const {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(base_.get(), sql, -1, &statement, nullptr);
  return Statement(statement);
}

void SqliteStream::read_topics() {
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  if (rows == nullptr) throw DataError(name_ + ": holds no topics of a rosbag2: " + error_text());
  int state = SQLITE_ROW;
  while ((state = sqlite3_step(rows.get())) == SQLITE_ROW) {
    Channel channel;
    channel.topic = text_of(rows.get(), 1);
    channel.type = plain_type(text_of(rows.get(), 2));
    channel.encoding_name = text_of(rows.get(), 3);
    channel.encoding = channel.encoding_name == "cdr" ? Encoding::kCdr : Encoding::kOther;
    channel_of_id_[sqlite3_column_int64(rows.get(), 0)] = channels_.size();
    channels_.push_back(std::move(channel));
  }
  if (state != SQLITE_DONE) throw DataError(name_ + ": its topics cannot be read: " + error_text());
}

void SqliteStream::read_definitions() {
  const Statement rows = prepare("SELECT topic_type, encoded_message_definition FROM message_definitions");
  while (rows != nullptr && sqlite3_step(rows.get()) == SQLITE_ROW) {
    const std::string type = plain_type(text_of(rows.get(), 0));
    for (Channel& channel : channels_) {
      if (channel.type == type) channel.schema = text_of(rows.get(), 1);
    }
  }
}

bool SqliteStream::next(Message& message) {
  int state = SQLITE_ROW;
  while (messages_ != nullptr && (state = sqlite3_step(messages_.get())) == SQLITE_ROW) {
    read_ = sqlite3_column_int64(messages_.get(), 0);
    const auto place = [this] { return name_ + ": message " + std::to_string(read_) + ": "; };
    const auto channel = channel_of_id_.find(sqlite3_column_int64(messages_.get(), 1));
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(messages_.get(), 3));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(messages_.get(), 3));
    const bool has_types = sqlite3_column_type(messages_.get(), 2) == SQLITE_INTEGER &&
                           sqlite3_column_type(messages_.get(), 3) == SQLITE_BLOB;
    if (channel == channel_of_id_.end() || data == nullptr || !has_types) {
      damage_.add([&] { return place() + "is of no known topic, empty or damaged"; });
      continue;
    }
    message.channel = channel->second;
    message.log_ns = sqlite3_column_int64(messages_.get(), 2);
    message.bytes = {data, size};
    if (message_compression_.empty()) return true;
    if (const char* rule = decompress(message_compression_, message.bytes, kMostRecordBytes, decompressed_)) {
      damage_.add([&] { return place() + rule; });
      continue;
    }
    message.bytes = decompressed_;
    return true;
  }
  if (messages_ != nullptr && state != SQLITE_DONE) {
    damage_.add([this] {
      return name_ + ": after message " + std::to_string(read_) + ": " + error_text() +
             "; what follows is left out";
    });
  }
  messages_.reset();
  return false;
}

double SqliteStream::progress() const {
  if (messages_ == nullptr || last_id_ <= 0) return 1.0;
  return std::clamp(static_cast<double>(read_) / static_cast<double>(last_id_), 0.0, 1.0);
}

}  // namespace isobar::imports

// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/mcap_stream.hpp"

#include <zlib.h>

#include <array>

#include "core/errors.hpp"
#include "run/import/decompress.hpp"
#include "run/mcap/mcap_format.hpp"

namespace isobar::imports {
namespace {

namespace opcode = mcap::opcode;

constexpr std::size_t kRecordHeadBytes = 9;
/// Most topics that are kept apart; damaged files could name any number.
constexpr std::size_t kMostMcapChannels = 65'536;

Encoding encoding_of(std::string_view name) {
  if (name == "cdr") return Encoding::kCdr;
  return name == "ros1" ? Encoding::kRos1 : Encoding::kOther;
}

}  // namespace

McapStream::McapStream(const std::filesystem::path& file) : RecordStream(file) {
  std::array<std::uint8_t, mcap::kMagic.size()> magic{};
  if (!file_.read(magic) || std::memcmp(magic.data(), mcap::kMagic.data(), magic.size()) != 0) {
    throw DataError(file_.name() + ": is no MCAP file of version 0");
  }
}

bool McapStream::next_in_file(McapRecord& record) {
  if (ended_) return false;
  record.at = file_.position();
  std::array<std::uint8_t, kRecordHeadBytes> head{};
  if (!file_.read(head)) {
    ended_ = true;
    note(record.at, "the file ends without the end of its data: it was cut, or never closed");
    return false;
  }
  record.opcode = head[0];
  std::uint64_t length = 0;
  std::memcpy(&length, &head[1], sizeof(length));
  if (record.opcode == opcode::kDataEnd || record.opcode == opcode::kFooter) {
    ended_ = true;
    return false;
  }
  // What is no data is passed over: attachments may be long.
  const bool is_read = record.opcode >= opcode::kSchema && record.opcode <= opcode::kChunk;
  if (is_read ? !file_.read(length, content_) : !file_.skip(length)) {
    ended_ = true;
    note(record.at, length > file_.left() ? "a record ends beyond the file, which is cut or damaged there"
                                          : "a record is longer than 512 MiB");
    return false;
  }
  record.content = is_read ? std::span<const std::uint8_t>(content_) : std::span<const std::uint8_t>{};
  return true;
}

void McapStream::read_record(ByteCursor& cursor, McapRecord& record) const {
  record.opcode = cursor.get<std::uint8_t>();
  record.content = cursor.take(cursor.get<std::uint64_t>());
}

void McapStream::open_chunk(const McapRecord& record) {
  ByteCursor cursor(record.content);
  cursor.take(2 * sizeof(std::uint64_t));  // span of time
  const auto size = cursor.get<std::uint64_t>();
  const auto crc = cursor.get<std::uint32_t>();
  const std::string_view method = cursor.text();
  const auto data = cursor.take(cursor.get<std::uint64_t>());
  if (!begin_chunk(record.at)) return;
  if (!cursor.ok()) return note(record.at, "a chunk is shorter than its fields");
  if (size > kMostRecordBytes) return note(record.at, "a chunk is longer than 512 MiB");
  if (const char* rule = decompress(method, data, size, chunk_); rule != nullptr) {
    note(record.at, rule);
    return;  // what came out is read: record by record, each with its length
  }
  if (crc != 0 && crc32(0, chunk_.data(), static_cast<unsigned>(chunk_.size())) != crc) {
    chunk_.clear();
    note(record.at, "the check sum of a chunk is wrong; the chunk is left out");
  }
}

bool McapStream::take(const McapRecord& record, Message& message) {
  ByteCursor cursor(record.content);
  switch (record.opcode) {
    case opcode::kSchema:
      add_schema(cursor);
      return false;
    case opcode::kChannel:
      add_channel(cursor);
      return false;
    case opcode::kChunk:
      open_chunk(record);
      return false;
    case opcode::kMessage:
      break;
    default:
      return false;
  }
  const auto channel = channel_of_id_.find(cursor.get<std::uint16_t>());
  cursor.get<std::uint32_t>();  // sequence
  message.log_ns = static_cast<std::int64_t>(cursor.get<std::uint64_t>());
  cursor.get<std::uint64_t>();  // time of publication
  message.bytes = cursor.take(cursor.left());
  if (!cursor.ok()) {
    note(record.at, "a message is shorter than its fields");
    return false;
  }
  if (channel == channel_of_id_.end()) {
    note(record.at, "a message of a channel that was not described");
    return false;
  }
  message.channel = channel->second;
  return true;
}

void McapStream::add_schema(ByteCursor cursor) {
  const auto id = cursor.get<std::uint16_t>();
  Schema schema;
  schema.name = cursor.text();
  cursor.text();  // encoding
  schema.text = cursor.text();
  if (cursor.ok()) schemas_[id] = std::move(schema);
}

void McapStream::add_channel(ByteCursor cursor) {
  const auto id = cursor.get<std::uint16_t>();
  const auto schema = schemas_.find(cursor.get<std::uint16_t>());
  Channel channel;
  channel.topic = cursor.text();
  channel.encoding_name = cursor.text();
  channel.encoding = encoding_of(channel.encoding_name);
  if (!cursor.ok() || channel_of_id_.contains(id) || channels_.size() >= kMostMcapChannels) return;
  if (schema != schemas_.end()) {
    channel.type = plain_type(schema->second.name);
    channel.schema = schema->second.text;
  }
  channel_of_id_[id] = channels_.size();
  channels_.push_back(std::move(channel));
}

}  // namespace isobar::imports

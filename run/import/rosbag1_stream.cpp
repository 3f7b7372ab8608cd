// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/rosbag1_stream.hpp"

#include <array>
#include <optional>

#include "core/errors.hpp"
#include "run/import/decompress.hpp"

namespace isobar::imports {
namespace {

enum RecordKind : std::uint8_t {
  kMessageData = 0x02,
  kBagHeader = 0x03,
  kChunkData = 0x05,
  kConnection = 0x07
};
constexpr std::uint32_t kMostHeaderBytes = 1U << 20U;
constexpr std::size_t kMostConnections = 65'536;

/// A field of a record's header: "name=value" behind its length; nothing where it is missing.
std::optional<std::span<const std::uint8_t>> field(std::span<const std::uint8_t> header,
                                                   std::string_view name) {
  for (ByteCursor cursor(header); cursor.left() > 0;) {
    const std::string_view text = cursor.text();
    if (!cursor.ok()) return std::nullopt;
    if (text.size() <= name.size() || !text.starts_with(name) || text[name.size()] != '=') continue;
    return std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())
        .subspan(name.size() + 1);
  }
  return std::nullopt;
}

template <typename Value>
std::optional<Value> number(std::span<const std::uint8_t> header, std::string_view name) {
  const auto bytes = field(header, name);
  if (!bytes || bytes->size() != sizeof(Value)) return std::nullopt;
  return ByteCursor(*bytes).get<Value>();
}

std::string text(std::span<const std::uint8_t> header, std::string_view name) {
  const auto bytes = field(header, name);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

}  // namespace

Rosbag1Stream::Rosbag1Stream(const std::filesystem::path& file) : RecordStream(file) {
  std::array<std::uint8_t, kRosbag1Magic.size()> magic{};
  if (!file_.read(magic) || std::memcmp(magic.data(), kRosbag1Magic.data(), magic.size()) != 0) {
    throw DataError(file_.name() + ": is no ROS 1 bag of version 2.0");
  }
}

bool Rosbag1Stream::next_in_file(Rosbag1Record& record) {
  if (ended_) return false;
  record.at = file_.position();
  if (file_.left() == 0) {
    ended_ = true;
    if (index_at_ == 0 || index_at_ > file_.size()) {
      note(record.at, "the file ends without its index: it was cut, or never closed");
    }
    return false;
  }
  std::array<std::uint8_t, sizeof(std::uint32_t)> length{};
  const auto part = [&](std::uint32_t most, std::vector<std::uint8_t>& to) {
    if (!file_.read(length)) return false;
    const auto size = ByteCursor(length).get<std::uint32_t>();
    return size <= most && file_.read(size, to);
  };
  if (!part(kMostHeaderBytes, header_) || !part(static_cast<std::uint32_t>(kMostRecordBytes), data_)) {
    ended_ = true;
    note(record.at, "a record ends beyond the file, which is cut or damaged there");
    return false;
  }
  record.header = header_;
  record.data = data_;
  return true;
}

void Rosbag1Stream::read_record(ByteCursor& cursor, Rosbag1Record& record) const {
  record.header = cursor.counted();
  record.data = cursor.counted();
}

bool Rosbag1Stream::take(const Rosbag1Record& record, Message& message) {
  const auto op = number<std::uint8_t>(record.header, "op");
  if (!op) {
    note(record.at, "a record says no kind");
    return false;
  }
  if (*op == kBagHeader) index_at_ = number<std::uint64_t>(record.header, "index_pos").value_or(0);
  if (*op == kConnection) add_connection(record);
  if (*op == kChunkData) open_chunk(record);
  if (*op != kMessageData) return false;
  const auto id = number<std::uint32_t>(record.header, "conn");
  const auto time = number<std::uint64_t>(record.header, "time");
  const auto channel = id ? channel_of_id_.find(*id) : channel_of_id_.end();
  if (!time || channel == channel_of_id_.end()) {
    note(record.at, "a message without its time, or of a connection that was not described");
    return false;
  }
  message.channel = channel->second;
  message.log_ns = static_cast<std::int64_t>(*time & 0xffff'ffffU) * 1'000'000'000 +
                   static_cast<std::int64_t>(*time >> 32U);
  message.bytes = record.data;
  return true;
}

void Rosbag1Stream::open_chunk(const Rosbag1Record& record) {
  const auto size = number<std::uint32_t>(record.header, "size");
  if (!begin_chunk(record.at)) return;
  if (!size || *size > kMostRecordBytes) return note(record.at, "a chunk without a size, or above 512 MiB");
  if (const char* rule = decompress(text(record.header, "compression"), record.data, *size, chunk_)) {
    note(record.at, rule);  // what came out is read
  }
}

void Rosbag1Stream::add_connection(const Rosbag1Record& record) {
  const auto id = number<std::uint32_t>(record.header, "conn");
  if (!id || channel_of_id_.contains(*id) || channels_.size() >= kMostConnections) return;
  Channel channel;
  channel.topic = text(record.header, "topic");
  channel.type = plain_type(text(record.data, "type"));
  channel.schema = text(record.data, "message_definition");
  channel.encoding = Encoding::kRos1;
  channel.encoding_name = "ros1";
  channel_of_id_[*id] = channels_.size();
  channels_.push_back(std::move(channel));
}

}  // namespace isobar::imports

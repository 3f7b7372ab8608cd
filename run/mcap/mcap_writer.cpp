// SPDX-License-Identifier: BSD-3-Clause
#include "run/mcap/mcap_writer.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>

#include "core/errors.hpp"
#include "run/mcap/mcap_format.hpp"
#include "run/mcap/message_definitions.hpp"

namespace isobar::mcap {

namespace {

constexpr std::string_view kProfile = "ros2";
constexpr std::string_view kCompression = "zstd";
// Faster than a robot's lidar fills it on one slow core, and within some per cent of the best ratio on clouds.
constexpr int kZstdLevel = 1;

std::span<const std::uint8_t> magic_bytes() {
  return {reinterpret_cast<const std::uint8_t*>(kMagic.data()), kMagic.size()};
}

void put_bytes(std::span<const std::uint8_t> bytes, Bytes& out) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void put_record(std::uint8_t opcode, std::span<const std::uint8_t> content, Bytes& out) {
  put(opcode, out);
  put(static_cast<std::uint64_t>(content.size()), out);
  put_bytes(content, out);
}

std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

Bytes compressed(const Bytes& plain) {
  Bytes out(ZSTD_compressBound(plain.size()));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) throw ServiceError(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file, std::string_view library) : file_(file) {
  append(magic_bytes());
  Bytes header;
  put_text(kProfile, header);
  put_text(library, header);
  append_record(opcode::kHeader, header);
}

void McapWriter::append(std::span<const std::uint8_t> bytes) {
  file_.write(bytes.data(), bytes.size());
  position_ += bytes.size();
}

void McapWriter::append_record(std::uint8_t opcode, std::span<const std::uint8_t> content) {
  Bytes record;
  put_record(opcode, content, record);
  append(record);
}

std::uint16_t McapWriter::schema_of(const std::string& type) {
  const auto known = schema_numbers_.find(type);
  if (known != schema_numbers_.end()) return known->second;
  const auto number = static_cast<std::uint16_t>(schemas_.size() + 1);  // 0 means none
  Bytes schema;
  put(number, schema);
  put_text(type, schema);
  put_text("ros2msg", schema);
  put_text(message_definition(type), schema);
  put_record(opcode::kSchema, schema, chunk_);
  schemas_.push_back(std::move(schema));
  schema_numbers_[type] = number;
  return number;
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& type) {
  const std::uint16_t schema = schema_of(type);
  const auto number = static_cast<std::uint16_t>(channels_.size() + 1);
  Channel channel;
  put(number, channel.record);
  put(schema, channel.record);
  put_text(topic, channel.record);
  put_text("cdr", channel.record);
  put(std::uint32_t{0}, channel.record);  // no metadata
  put_record(opcode::kChannel, channel.record, chunk_);
  channels_.push_back(std::move(channel));
  return number;
}

void McapWriter::write(std::uint16_t channel, std::int64_t stamp_ns, std::span<const std::uint8_t> cdr) {
  const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(stamp_ns, 0));
  index_[channel].push_back({time_ns, chunk_.size()});
  put(opcode::kMessage, chunk_);
  put(static_cast<std::uint64_t>(sizeof channel + sizeof sequence_ + 2 * sizeof time_ns + cdr.size()),
      chunk_);
  put(channel, chunk_);
  put(sequence_++, chunk_);
  put(time_ns, chunk_);  // log time
  put(time_ns, chunk_);  // publish time
  put_bytes(cdr, chunk_);
  const bool is_first = index_.size() == 1 && index_[channel].size() == 1;
  chunk_first_ns_ = is_first ? time_ns : std::min(chunk_first_ns_, time_ns);
  chunk_last_ns_ = is_first ? time_ns : std::max(chunk_last_ns_, time_ns);
  ++channels_.at(channel - 1U).messages;
  ++messages_;
  if (chunk_.size() >= kChunkBytes) flush();
}

void McapWriter::flush() {
  if (chunk_.empty()) return;
  const Bytes packed = compressed(chunk_);
  Bytes content;
  put(index_.empty() ? std::uint64_t{0} : chunk_first_ns_, content);
  put(index_.empty() ? std::uint64_t{0} : chunk_last_ns_, content);
  put(static_cast<std::uint64_t>(chunk_.size()), content);
  put(crc_of(chunk_), content);
  put_text(kCompression, content);
  put(static_cast<std::uint64_t>(packed.size()), content);
  put_bytes(packed, content);
  ChunkEntry entry{chunk_first_ns_, chunk_last_ns_, position_, 0, {}, 0, packed.size(), chunk_.size()};
  append_record(opcode::kChunk, content);
  entry.length = position_ - entry.start;
  write_indexes(entry);
  chunks_.push_back(std::move(entry));
  chunk_.clear();
  index_.clear();
}

void McapWriter::write_indexes(ChunkEntry& entry) {
  const std::uint64_t begin = position_;
  for (const auto& [channel, messages] : index_) {
    entry.index_offsets[channel] = position_;
    Bytes content;
    put(channel, content);
    put(static_cast<std::uint32_t>(messages.size() * sizeof(IndexEntry)), content);
    for (const IndexEntry& message : messages) {
      put(message.stamp_ns, content);
      put(message.offset, content);
    }
    append_record(opcode::kMessageIndex, content);
  }
  entry.index_length = position_ - begin;
}

Bytes McapWriter::statistics() const {
  std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last_ns = 0;
  for (const ChunkEntry& chunk : chunks_) {
    if (chunk.index_offsets.empty()) continue;
    first_ns = std::min(first_ns, chunk.first_ns);
    last_ns = std::max(last_ns, chunk.last_ns);
  }
  Bytes content;
  put(messages_, content);
  put(static_cast<std::uint16_t>(schemas_.size()), content);
  put(static_cast<std::uint32_t>(channels_.size()), content);
  put(std::uint32_t{0}, content);  // attachments
  put(std::uint32_t{0}, content);  // metadata
  put(static_cast<std::uint32_t>(chunks_.size()), content);
  put(messages_ == 0 ? std::uint64_t{0} : first_ns, content);
  put(last_ns, content);
  put(static_cast<std::uint32_t>(channels_.size() * (sizeof(std::uint16_t) + sizeof(std::uint64_t))),
      content);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    put(static_cast<std::uint16_t>(i + 1), content);
    put(channels_[i].messages, content);
  }
  return content;
}

void McapWriter::write_summary() {
  const std::uint64_t start = position_;
  Bytes summary;
  Bytes offsets;
  const auto group = [&](std::uint8_t opcode, const auto& put_records) {
    const std::uint64_t begin = start + summary.size();
    put_records();
    const std::uint64_t length = start + summary.size() - begin;
    if (length == 0) return;
    Bytes content;
    put(opcode, content);
    put(begin, content);
    put(length, content);
    put_record(opcode::kSummaryOffset, content, offsets);
  };
  group(opcode::kSchema, [&] {
    for (const Bytes& schema : schemas_) put_record(opcode::kSchema, schema, summary);
  });
  group(opcode::kChannel, [&] {
    for (const Channel& channel : channels_) put_record(opcode::kChannel, channel.record, summary);
  });
  group(opcode::kStatistics, [&] { put_record(opcode::kStatistics, statistics(), summary); });
  group(opcode::kChunkIndex, [&] {
    for (const ChunkEntry& chunk : chunks_) put_record(opcode::kChunkIndex, chunk_index(chunk), summary);
  });
  Bytes footer;
  put(start, footer);
  put(start + summary.size(), footer);
  put_bytes(offsets, summary);
  // The checksum covers the summary and the footer up to the checksum itself.
  put(opcode::kFooter, summary);
  put(static_cast<std::uint64_t>(footer.size() + sizeof(std::uint32_t)), summary);
  put_bytes(footer, summary);
  put(crc_of(summary), summary);
  append(summary);
}

Bytes McapWriter::chunk_index(const ChunkEntry& chunk) {
  Bytes content;
  put(chunk.first_ns, content);
  put(chunk.last_ns, content);
  put(chunk.start, content);
  put(chunk.length, content);
  put(static_cast<std::uint32_t>(chunk.index_offsets.size() *
                                 (sizeof(std::uint16_t) + sizeof(std::uint64_t))),
      content);
  for (const auto& [channel, offset] : chunk.index_offsets) {
    put(channel, content);
    put(offset, content);
  }
  put(chunk.index_length, content);
  put_text(kCompression, content);
  put(chunk.compressed_bytes, content);
  put(chunk.uncompressed_bytes, content);
  return content;
}

void McapWriter::close() {
  flush();
  Bytes end;
  put(std::uint32_t{0}, end);  // no checksum of the data: each chunk has its own
  append_record(opcode::kDataEnd, end);
  write_summary();
  append(magic_bytes());
  file_.close();
}

}  // namespace isobar::mcap

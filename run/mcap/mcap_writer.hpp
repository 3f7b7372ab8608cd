// SPDX-License-Identifier: BSD-3-Clause
// Writer of MCAP files (mcap.dev/spec, version 0): chunks with zstd, message indexes, summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "run/files/part_file.hpp"
#include "run/mcap/little_endian.hpp"

namespace isobar::mcap {

/// The file appears, or is replaced, as a whole by close(); until then it is FILE.part, readable up to its last chunk:
/// readers of MCAP scan files without summary.
class McapWriter {
 public:
  /// Uncompressed size at which a chunk is written.
  static constexpr std::size_t kChunkBytes = 4U << 20U;

  /// @param library program that writes, with its version
  /// @throws ServiceError naming the file when it cannot be created
  McapWriter(const std::filesystem::path& file, std::string_view library);

  /// Adds a topic with messages in CDR.
  /// @param type "nav_msgs/msg/Odometry", one of message_definition()
  /// @return number of the channel for write()
  std::uint16_t add_channel(const std::string& topic, const std::string& type);
  /// Appends a message: log and publish time are its stamp [ns since the epoch].
  /// @throws ServiceError naming the file when the disk is full
  void write(std::uint16_t channel, std::int64_t stamp_ns, std::span<const std::uint8_t> cdr);
  /// Writes the chunk that is begun, so that a crash loses nothing that was written before.
  void flush();
  /// Writes summary and end. Nothing can be written afterwards.
  void close();
  /// Removes what was written; nothing can be written afterwards.
  void abandon() { file_.abandon(); }

  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t bytes() const { return position_; }

 private:
  struct IndexEntry {
    std::uint64_t stamp_ns;
    std::uint64_t offset;  ///< within the chunk's records
  };
  struct ChunkEntry {
    std::uint64_t first_ns;
    std::uint64_t last_ns;
    std::uint64_t start;   ///< of the chunk in the file
    std::uint64_t length;  ///< of the chunk, with opcode and length
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_length;
    std::uint64_t compressed_bytes;
    std::uint64_t uncompressed_bytes;
  };
  struct Channel {
    Bytes record;  ///< content of its record
    std::uint64_t messages = 0;
  };

  std::uint16_t schema_of(const std::string& type);
  void append(std::span<const std::uint8_t> bytes);
  void append_record(std::uint8_t opcode, std::span<const std::uint8_t> content);
  void write_indexes(ChunkEntry& entry);
  void write_summary();
  [[nodiscard]] Bytes statistics() const;
  static Bytes chunk_index(const ChunkEntry& chunk);

  files::PartFile file_;
  std::uint64_t position_ = 0;
  std::map<std::string, std::uint16_t> schema_numbers_;
  std::vector<Bytes> schemas_;     ///< contents of their records
  std::vector<Channel> channels_;  ///< by number, from 1
  Bytes chunk_;                    ///< records of the chunk that is begun
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;
  std::uint64_t chunk_first_ns_ = 0;
  std::uint64_t chunk_last_ns_ = 0;
  std::vector<ChunkEntry> chunks_;
  std::uint64_t messages_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace isobar::mcap

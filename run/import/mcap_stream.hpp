// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "run/import/byte_cursor.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/message_stream.hpp"

namespace isobar::imports {

/// Reader of an MCAP file (mcap.dev/spec, major version 0): chunks none, lz4 and zstd, or without chunks; the summary
/// behind the data is not needed.
class McapStream : public MessageStream {
 public:
  /// @throws DataError when the file cannot be read or does not begin as an MCAP
  explicit McapStream(const std::filesystem::path& file);

  bool next(Message& message) override;
  [[nodiscard]] const std::vector<Channel>& channels() const override { return channels_; }
  [[nodiscard]] const recording::Tally& damage() const override { return damage_; }
  [[nodiscard]] double progress() const override;
  [[nodiscard]] std::string container() const override { return "MCAP"; }

 private:
  struct Schema {
    std::string name;
    std::string text;
  };
  struct Record {
    std::uint8_t opcode = 0;
    std::uint64_t at = 0;  // in the file
    std::span<const std::uint8_t> content;
  };

  bool next_in_file(Record& record);
  bool next_in_chunk(Record& record);
  void open_chunk(const Record& record);
  bool take(const Record& record, Message& message);
  void add_schema(ByteCursor cursor);
  void add_channel(ByteCursor cursor);
  void note(std::uint64_t at, const char* rule);

  FileBytes file_;
  std::vector<std::uint8_t> content_;  // of the last record in the file
  std::vector<std::uint8_t> chunk_;
  std::size_t chunk_used_ = 0;
  std::uint64_t chunk_at_ = 0;  // in the file
  bool ended_ = false;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::size_t> channel_of_id_;
  std::vector<Channel> channels_;
  recording::Tally damage_;
};

}  // namespace isobar::imports

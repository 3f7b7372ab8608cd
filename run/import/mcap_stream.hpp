// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "run/import/byte_cursor.hpp"
#include "run/import/message_stream.hpp"
#include "run/import/record_stream.hpp"

namespace isobar::imports {

struct McapRecord {
  std::uint8_t opcode = 0;
  std::uint64_t at = 0;  ///< in the file
  std::span<const std::uint8_t> content;
};

/// Reader of an MCAP file (mcap.dev/spec, major version 0): chunks none, lz4 and zstd, or without chunks; the summary
/// behind the data is not needed.
class McapStream : public RecordStream<McapRecord> {
 public:
  /// @throws DataError when the file cannot be read or does not begin as an MCAP
  explicit McapStream(const std::filesystem::path& file);

  [[nodiscard]] std::string container() const override { return "MCAP"; }

 private:
  struct Schema {
    std::string name;
    std::string text;
  };

  bool next_in_file(McapRecord& record) override;
  void read_record(ByteCursor& cursor, McapRecord& record) const override;
  bool take(const McapRecord& record, Message& message) override;
  void open_chunk(const McapRecord& record);
  void add_schema(ByteCursor cursor);
  void add_channel(ByteCursor cursor);

  std::vector<std::uint8_t> content_;  // of the last record in the file
  bool ended_ = false;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::size_t> channel_of_id_;
};

}  // namespace isobar::imports

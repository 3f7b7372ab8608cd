// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "run/import/byte_cursor.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/message_stream.hpp"

namespace isobar::imports {

/// Reader of a file of records, of which some are chunks: compressed records of the same form.
/// `Record`: the parts of a record, with its place in the file in `at`.
template <typename Record>
class RecordStream : public MessageStream {
 public:
  bool next(Message& message) final {
    Record record;
    for (;;) {
      is_in_chunk_ = next_in_chunk(record);
      if (!is_in_chunk_ && !next_in_file(record)) return false;
      if (take(record, message)) return true;
    }
  }
  [[nodiscard]] const std::vector<Channel>& channels() const final { return channels_; }
  [[nodiscard]] const recording::Tally& damage() const final { return damage_; }
  [[nodiscard]] double progress() const final {
    return file_.size() > 0 ? static_cast<double>(file_.position()) / static_cast<double>(file_.size()) : 1.0;
  }

 protected:
  /// @throws DataError when the file cannot be read
  explicit RecordStream(const std::filesystem::path& file) : file_(file) {}

  /// The next record of the file; false at its end.
  virtual bool next_in_file(Record& record) = 0;
  /// Reads a record of a chunk; the cursor is not ok() where it ends too early.
  virtual void read_record(ByteCursor& cursor, Record& record) const = 0;
  /// Uses a record; true where it is a message.
  virtual bool take(const Record& record, Message& message) = 0;

  /// Counts damage at a byte of the file.
  void note(std::uint64_t at, const char* rule) {
    damage_.add([&] { return file_.place(at) + rule; });
  }
  /// Drops the chunk; its successor, at this byte of the file, goes into `chunk_`. False within a chunk, where none may be:
  /// its bytes are those that would be dropped.
  bool begin_chunk(std::uint64_t at) {
    if (is_in_chunk_) {
      note(at, "a chunk within a chunk");
      return false;
    }
    chunk_at_ = at;
    chunk_used_ = 0;
    chunk_.clear();
    return true;
  }

  FileBytes file_;
  std::vector<std::uint8_t> chunk_;  // decompressed
  std::vector<Channel> channels_;

 private:
  bool next_in_chunk(Record& record) {
    if (chunk_used_ >= chunk_.size()) return false;
    ByteCursor cursor(std::span<const std::uint8_t>(chunk_).subspan(chunk_used_));
    record.at = chunk_at_;
    read_record(cursor, record);
    if (!cursor.ok()) {
      chunk_used_ = chunk_.size();
      note(chunk_at_, "a record ends beyond its chunk");
      return false;
    }
    chunk_used_ += cursor.at();
    return true;
  }

  bool is_in_chunk_ = false;  // the record that is taken
  std::size_t chunk_used_ = 0;
  std::uint64_t chunk_at_ = 0;  // in the file
  recording::Tally damage_;
};

}  // namespace isobar::imports

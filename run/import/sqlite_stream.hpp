// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "run/import/message_stream.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace isobar::imports {

inline constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

/// Reader of one SQLite file of a rosbag2, in the order in which it was written. The file is not changed.
class SqliteStream : public MessageStream {
 public:
  /// @param message_compression "zstd" where each message is compressed; else empty
  /// @throws DataError when the file cannot be read or holds no rosbag2
  explicit SqliteStream(const std::filesystem::path& file, std::string message_compression = {});

  bool next(Message& message) override;
  [[nodiscard]] const std::vector<Channel>& channels() const override { return channels_; }
  [[nodiscard]] const recording::Tally& damage() const override { return damage_; }
  [[nodiscard]] double progress() const override;
  [[nodiscard]] std::string container() const override { return "rosbag2 (sqlite3)"; }

 private:
  struct Closer {
    void operator()(sqlite3* base) const;
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Closer>;

  [[nodiscard]] Statement prepare(const char* sql) const;
  void read_topics();
  void read_definitions();
  [[nodiscard]] std::string error_text() const;

  std::string name_;
  std::string message_compression_;
  std::vector<std::uint8_t> decompressed_;
  std::unique_ptr<sqlite3, Closer> base_;
  Statement messages_;
  std::map<std::int64_t, std::size_t> channel_of_id_;
  std::vector<Channel> channels_;
  std::int64_t read_ = 0;
  std::int64_t last_id_ = 0;  // of the file
  recording::Tally damage_;
};

}  // namespace isobar::imports

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/import/message_stream.hpp"

namespace isobar::imports {

/// What the metadata.yaml of a rosbag2 says, as far as it is needed.
struct BagMetadata {
  std::vector<std::string> files;  ///< below the folder, in their order
  std::string compression_format;  ///< "zstd" or empty
  std::string compression_mode;    ///< "file", "message" or empty
  bool is_listed = false;          ///< the files are those that metadata.yaml names

  /// How each message is compressed; empty: it is not.
  [[nodiscard]] std::string message_compression() const {
    return compression_mode == "message" ? compression_format : std::string();
  }
};

/// Reads the lines of a metadata.yaml that rosbag2 writes; any other text gives nothing.
[[nodiscard]] BagMetadata parse_bag_metadata(std::string_view text);

/// Files of a bag in a folder, by the metadata.yaml of a rosbag2; where that is missing, or names none that exists, the .db3,
/// .mcap and .bag files, compressed or not, in the order of their numbers.
[[nodiscard]] BagMetadata find_bag(const std::filesystem::path& folder);

/// Number of a part of a divided bag: 3 of "name_3.bag" and "name_3.db3.zstd".
[[nodiscard]] std::optional<std::int64_t> part_number(const std::string& file_name);

/// Name of the part that follows a file, where it lies beside it: "name_4.bag" beside "name_3.bag".
[[nodiscard]] std::optional<std::string> next_part(const std::filesystem::path& file);

/// The files of a bag, one after the other.
class BagFolder : public MessageStream {
 public:
  /// @throws DataError when the folder holds none that can be read, or several bags that are no parts of one
  explicit BagFolder(const std::filesystem::path& folder);

  bool next(Message& message) override;
  [[nodiscard]] const std::vector<Channel>& channels() const override { return channels_; }
  [[nodiscard]] const recording::Tally& damage() const override { return damage_; }
  [[nodiscard]] double progress() const override;
  [[nodiscard]] std::string container() const override { return container_; }

 private:
  void open_next();
  void leave_file();

  std::filesystem::path folder_;
  BagMetadata metadata_;
  std::size_t opened_ = 0;
  std::unique_ptr<MessageStream> file_;
  std::string container_;
  std::vector<Channel> channels_;  // of all files
  std::vector<std::size_t> channel_of_file_;
  recording::Tally damage_;
};

}  // namespace isobar::imports

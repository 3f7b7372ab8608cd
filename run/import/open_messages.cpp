// SPDX-License-Identifier: BSD-3-Clause
#include <system_error>

#include "core/errors.hpp"
#include "run/import/bag_folder.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/mcap_stream.hpp"
#include "run/import/message_stream.hpp"
#include "run/import/packed_file.hpp"
#include "run/import/rosbag1_stream.hpp"
#include "run/import/sqlite_stream.hpp"
#include "run/mcap/mcap_format.hpp"

namespace isobar::imports {

std::string plain_type(const std::string& type) {
  const std::size_t middle = type.find("/msg/");
  return middle == std::string::npos ? type : type.substr(0, middle) + type.substr(middle + 4);
}

bool holds_messages(const std::filesystem::path& source) {
  std::error_code error;
  if (std::filesystem::is_directory(source, error)) return !find_bag(source).files.empty();
  const std::string head = unpacked_head_of(source, kSqliteMagic.size());
  return head == kSqliteMagic || head.starts_with(mcap::kMagic) || head.starts_with(kRosbag1Magic);
}

std::unique_ptr<MessageStream> open_message_file(const std::filesystem::path& file,
                                                 const std::string& message_compression) {
  if (is_packed(file)) return open_packed(file);
  const std::string head = head_of(file, kSqliteMagic.size());
  if (head == kSqliteMagic) return std::make_unique<SqliteStream>(file, message_compression);
  if (head.starts_with(mcap::kMagic)) return std::make_unique<McapStream>(file);
  if (head.starts_with("#ROSBAG")) return std::make_unique<Rosbag1Stream>(file);
  throw DataError(file.string() + ": is no rosbag1, rosbag2 or MCAP");
}

std::unique_ptr<MessageStream> open_messages(const std::filesystem::path& source) {
  std::error_code error;
  if (std::filesystem::is_directory(source, error)) return std::make_unique<BagFolder>(source);
  // The metadata beside the file tell whether its messages are compressed.
  const BagMetadata metadata = find_bag(source.parent_path().empty() ? "." : source.parent_path());
  return open_message_file(source, metadata.message_compression());
}

}  // namespace isobar::imports

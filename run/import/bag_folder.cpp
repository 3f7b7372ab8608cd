// SPDX-License-Identifier: BSD-3-Clause
#include "run/import/bag_folder.hpp"

#include <algorithm>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "run/text/number_text.hpp"
#include "run/text/small_file.hpp"

namespace isobar::imports {
namespace {

constexpr std::uint64_t kMostMetadataBytes = 16U << 20U;

/// The value behind "key:" in a line; empty for other lines.
std::string_view value_of(std::string_view line, std::string_view key) {
  line = text::trimmed(line);
  if (!line.starts_with(key) || line.size() <= key.size() || line[key.size()] != ':') return {};
  return text::trimmed(line.substr(key.size() + 1));
}

/// Whether a name stays inside its folder.
bool stays_inside(const std::filesystem::path& name) {
  return !name.empty() && !name.is_absolute() &&
         std::none_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
}

/// The name without the endings of compression and container, in that order; empty for any other file.
std::string bare_name(const std::string& file_name) {
  std::filesystem::path name = file_name;
  const std::string packing = name.extension();
  if (packing == ".zstd" || packing == ".zst" || packing == ".gz") name = name.stem();
  if (name.extension() == ".active") name = name.stem();
  const std::string container = name.extension();
  const bool is_bag = container == ".db3" || container == ".mcap" || container == ".bag";
  return is_bag ? name.stem().string() : std::string();
}

/// What stands before the number at the end of a bare name: "bag_" of "bag_10".
std::string before_number(const std::string& bare) {
  return bare.substr(0, bare.find_last_not_of("0123456789") + 1);
}

/// "bag_10.db3" comes after "bag_9.db3".
bool comes_before(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() < b.size() : a < b;
}

std::vector<std::string> bag_files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename();
    if (!bare_name(name).empty() && entry.is_regular_file(error)) names.push_back(name);
  }
  const bool has_numbers =
      std::all_of(names.begin(), names.end(), [](const std::string& name) { return part_number(name); });
  // rosbag1 puts the time of each part before its number.
  std::sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return has_numbers && part_number(a) != part_number(b) ? part_number(a) < part_number(b)
                                                           : comes_before(a, b);
  });
  return names;
}

/// Files that a folder without metadata holds are one bag where they count 0, 1, 2 …, or share their name before the number.
bool are_parts(const std::vector<std::string>& names) {
  const auto base = [](const std::string& name) { return before_number(bare_name(name)); };
  bool counts = true;
  bool shares = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    counts = counts && part_number(names[i]) == static_cast<std::int64_t>(i);
    shares = shares && part_number(names[i]) && base(names[i]) == base(names[0]);
  }
  return names.size() == 1 || counts || shares;
}

}  // namespace

BagMetadata parse_bag_metadata(std::string_view text) {
  BagMetadata metadata;
  bool in_files = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view bare = text::trimmed(line);
    if (in_files && bare.starts_with("- ")) {
      const std::string name(text::trimmed(bare.substr(2)));
      if (stays_inside(name)) metadata.files.push_back(name);
      continue;
    }
    in_files = bare == "relative_file_paths:";
    if (const auto value = value_of(line, "compression_format"); !value.empty()) {
      metadata.compression_format = value;
    }
    if (const auto value = value_of(line, "compression_mode"); !value.empty()) {
      metadata.compression_mode = value;
    }
  }
  const auto lower = [](std::string& word) {
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return c < 128 ? static_cast<char>(std::tolower(c)) : '?'; });
  };
  lower(metadata.compression_format);
  lower(metadata.compression_mode);
  return metadata;
}

BagMetadata find_bag(const std::filesystem::path& folder) {
  const auto read = text::read_small_file(folder / "metadata.yaml", kMostMetadataBytes);
  BagMetadata metadata = parse_bag_metadata(read.content);
  std::erase_if(metadata.files, [&](const std::string& name) {
    std::error_code error;
    return !std::filesystem::exists(folder / name, error);
  });
  metadata.is_listed = !metadata.files.empty();
  // A bag that was renamed keeps the old names in its metadata.
  if (!metadata.is_listed) metadata.files = bag_files_in(folder);
  return metadata;
}

std::optional<std::int64_t> part_number(const std::string& file_name) {
  const std::string bare = bare_name(file_name);
  const std::string base = before_number(bare);
  std::int64_t number = 0;
  if (!base.ends_with('_') || !text::parse_number(bare.substr(base.size()), number)) return std::nullopt;
  return number;
}

std::optional<std::string> next_part(const std::filesystem::path& file) {
  const std::string name = file.filename();
  const auto number = part_number(name);
  if (!number) return std::nullopt;
  const std::string bare = bare_name(name);
  const std::string next = before_number(bare) + std::to_string(*number + 1) + name.substr(bare.size());
  std::error_code error;
  return std::filesystem::exists(file.parent_path() / next, error) ? std::optional(next) : std::nullopt;
}

BagFolder::BagFolder(const std::filesystem::path& folder) : folder_(folder), metadata_(find_bag(folder)) {
  if (metadata_.files.empty()) throw DataError(folder.string() + ": holds no .db3, .mcap or .bag file");
  if (!metadata_.is_listed && !are_parts(metadata_.files)) {
    std::string names;
    for (const std::string& name : metadata_.files) names += (names.empty() ? "" : ", ") + name;
    throw DataError(folder.string() + ": holds several bags: " + printable(names, 500) +
                    "; name one of them");
  }
  open_next();
}

void BagFolder::open_next() {
  const std::filesystem::path file = folder_ / metadata_.files[opened_++];
  channel_of_file_.clear();
  try {
    file_ = open_message_file(file, metadata_.message_compression());
    container_ = metadata_.files.size() == 1
                     ? file_->container()
                     : file_->container() + ", " + std::to_string(metadata_.files.size()) + " files";
  } catch (const DataError& error) {
    if (metadata_.files.size() == 1) throw;
    damage_.add([&] { return std::string(error.what()); });
  }
}

void BagFolder::leave_file() {
  if (file_ != nullptr && file_->damage().count > 0) {
    damage_.add([this] { return file_->damage().first_message; });
  }
  file_.reset();
}

bool BagFolder::next(Message& message) {
  while (file_ != nullptr || opened_ < metadata_.files.size()) {
    if (file_ == nullptr) {
      open_next();
      continue;
    }
    if (!file_->next(message)) {
      leave_file();
      continue;
    }
    // A topic has the same place in channels() whatever file it is in.
    const std::vector<Channel>& of_file = file_->channels();
    for (std::size_t i = channel_of_file_.size(); i < of_file.size(); ++i) {
      const auto known = std::find_if(channels_.begin(), channels_.end(), [&](const Channel& channel) {
        return channel.topic == of_file[i].topic && channel.type == of_file[i].type;
      });
      channel_of_file_.push_back(static_cast<std::size_t>(known - channels_.begin()));
      if (known == channels_.end()) channels_.push_back(of_file[i]);
    }
    message.channel = channel_of_file_[message.channel];
    return true;
  }
  return false;
}

double BagFolder::progress() const {
  const double before = static_cast<double>(opened_) - (file_ == nullptr ? 0.0 : 1.0);
  const double within = file_ == nullptr ? 0.0 : file_->progress();
  return (before + within) / static_cast<double>(metadata_.files.size());
}

}  // namespace isobar::imports

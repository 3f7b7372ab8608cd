// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/map_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/errors.hpp"
#include "run/text/bounded_toml.hpp"
#include "run/text/small_file.hpp"

namespace isobar {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxTileM = 1'000.0;     // plausibility of a header; a tile is 8.8 m by default
constexpr std::size_t kNumberDigits = 8;  // digits of NNNNNNNN.tiles

/// Parsed map.toml; its errors name file, line, column, key and rule.
class HeaderText {
 public:
  explicit HeaderText(const fs::path& file) : file_(file.string()) {
    const text::SmallFile read = text::read_small_file(file, text::kMostConfigBytes);
    if (!read.refusal.empty()) {
      throw DataError(file_ + ": " + read.refusal + "; a folder without this file holds no map");
    }
    try {
      table_ = text::parse_bounded_toml(read.content, file_);
    } catch (const text::TomlError& error) {
      throw DataError(error.at(file_));
    }
  }

  void must_be(const char* key, std::int64_t only, const std::string& rule) const {
    const toml::node& node = entry(key, rule);
    // value_exact(), because value() casts a float to an integer first, which is undefined for 1e72.
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value != only) fail(node, key, rule);
  }

  [[nodiscard]] double number(const char* key, double lowest, double highest, const std::string& rule) const {
    const toml::node& node = entry(key, rule);
    const auto value = node.value<double>();
    if (!value || !(*value >= lowest && *value <= highest)) fail(node, key, rule);
    return *value;
  }

 private:
  [[nodiscard]] const toml::node& entry(const char* key, const std::string& rule) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) throw DataError(file_ + ": " + key + ": is missing; " + rule);
    return *node;
  }
  [[noreturn]] void fail(const toml::node& node, const char* key, const std::string& rule) const {
    throw DataError(place(node.source()) + key + ": " + rule);
  }
  [[nodiscard]] std::string place(const toml::source_region& at) const {
    return file_ + ":" + std::to_string(at.begin.line) + ":" + std::to_string(at.begin.column) + ": ";
  }
  std::string file_;
  toml::table table_;
};

/// Number in a name such as 00000012.tiles; -1 for other names.
std::int64_t number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool is_number =
      stem.size() == kNumberDigits && error == std::errc() && end == stem.data() + stem.size();
  return is_number ? std::int64_t{number} : -1;
}

std::string holder_of(const fs::path& lock_file) {
  std::ifstream in(lock_file);
  std::string line;
  std::getline(in, line);
  return line.empty() ? "another process" : line;
}

}  // namespace

MapHeader read_map_header(const fs::path& directory) {
  const HeaderText text(directory / "map.toml");
  text.must_be(
      "format", MapHeader::kFormat,
      "must be " + std::to_string(MapHeader::kFormat) + ": this program supports no other format of map");
  MapHeader header;
  header.tile_m = text.number("tile_m", 1e-3, kMaxTileM, "must be a number within 0.001 … 1000 m");
  header.cell_m = text.number("cell_m", 1e-3, header.tile_m, "must be a number within 0.001 m … tile_m");
  return header;
}

void write_map_header(const fs::path& directory, const MapHeader& header) {
  const fs::path file = directory / "map.toml";
  const fs::path part = directory / "map.toml.part";
  std::ostringstream text;
  text << "# Map of Isobar. `isobar map info` prints its content.\n"
       << "format = " << MapHeader::kFormat << "\n";
  text.precision(17);
  text.setf(std::ios::showpoint);
  text << "tile_m = " << header.tile_m << "\ncell_m = " << header.cell_m << "\n";
  const std::string content = text.str();
  const FileDescriptor out(::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  const auto size = static_cast<ssize_t>(content.size());
  if (!out || ::write(out.get(), content.data(), content.size()) != size || ::fsync(out.get()) != 0 ||
      ::rename(part.c_str(), file.c_str()) != 0) {
    throw ServiceError(file.string() + ": cannot be written: " + errno_message());
  }
  sync_folder(directory);
}

void sync_folder(const fs::path& directory) noexcept {
  const FileDescriptor folder(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  static_cast<void>(!folder || ::fsync(folder.get()) == 0);
}

bool MapLock::in_place() const {
  struct stat held {};
  struct stat named {};
  return ::fstat(file_.get(), &held) == 0 && ::stat(path_.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

MapLock::MapLock(const fs::path& directory) : path_(directory / "lock") {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw ServiceError(directory.string() + ": cannot be created: " + error.message());
  const fs::path& file = path_;
  file_ = FileDescriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!file_) throw ServiceError(file.string() + ": cannot be opened: " + errno_message());
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) throw ServiceError(file.string() + ": cannot be locked: " + errno_message());
    throw ServiceError(directory.string() + ": " + holder_of(file) +
                       " writes this map; only one process may write it at a time");
  }
  // Name of the holder for the error above in another process. A failure is ignored: the lock holds without
  // it.
  const std::string holder =
      std::string(program_invocation_short_name) + " (process " + std::to_string(::getpid()) + ")\n";
  static_cast<void>(::ftruncate(file_.get(), 0) == 0 &&
                    ::pwrite(file_.get(), holder.data(), holder.size(), 0) > 0);
}

std::vector<std::uint32_t> file_numbers(const fs::path& directory, const char* extension) {
  std::vector<std::uint32_t> numbers;
  std::error_code error;
  fs::directory_iterator entries(directory, error);
  if (error) throw ServiceError(directory.string() + ": cannot be read: " + error.message());
  for (const auto& entry : entries) {
    const std::int64_t number = number_of(entry.path());
    if (number >= 0 && entry.path().extension() == extension) {
      numbers.push_back(static_cast<std::uint32_t>(number));
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

fs::path numbered_file(const fs::path& directory, std::uint32_t number, const char* extension) {
  std::array<char, 24> name{};
  std::snprintf(name.data(), name.size(), "%08u%s", static_cast<unsigned>(number), extension);
  return directory / name.data();
}

bool is_of_tiles(const fs::path& file) {
  return file.filename() == "map.toml" || file.filename() == "lock" || file.extension() == kTilesExtension ||
         file.extension() == ".index" || file.extension() == kScansExtension;
}

void remove_map(const fs::path& directory) {
  std::vector<fs::path> files{directory / "map.toml", directory / "checkpoint"};
  const fs::path building = directory / kBuildingFolder;
  for (const fs::path& folder : {directory, building}) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const auto extension = entry.path().extension();
      const bool is_ours =
          extension == kTilesExtension || extension == ".index" || extension == kScansExtension;
      if (is_ours && number_of(entry.path()) >= 0) files.push_back(entry.path());
    }
  }
  std::error_code missing;
  if (fs::exists(building, missing)) {
    files.insert(files.end(), {building / "building.log", building / "lock", building});
  }
  for (const fs::path& file : files) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw ServiceError(file.string() + ": cannot be removed: " + error.message());
  }
}

}  // namespace isobar

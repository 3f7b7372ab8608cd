// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/black_box_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "core/errors.hpp"
#include "daemon/service_folder.hpp"
#include "run/recording/record_session.hpp"
#include "run/tile_store/file_descriptor.hpp"

namespace isobar::black_box {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRingPrefix = "ring-";
constexpr std::size_t kStampLength = 16;  // "20261128T202117Z"

void make_private(const fs::path& folder) {
  if (::mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    throw ServiceError(folder.string() + ": cannot be made: " + errno_message());
  }
  struct stat status {};
  const bool known = ::lstat(folder.c_str(), &status) == 0;
  if (!known || !S_ISDIR(status.st_mode) || status.st_uid != ::geteuid() ||
      (status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw ServiceError(folder.string() + ": is no private folder of this user; remove it (rm -r " +
                       folder.string() + ")");
  }
}

std::string utc_stamp(std::time_t utc_s) {
  std::tm time{};
  ::gmtime_r(&utc_s, &time);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &time);
  return text.data();
}

}  // namespace

fs::path memory_folder() {
  const fs::path runtime = service_folder("RUNTIME_DIRECTORY");
  fs::path folder = runtime.empty() ? fs::path("/dev/shm/isobar-blackbox-" + std::to_string(::geteuid()))
                                    : runtime / "blackbox";
  make_private(folder);
  return folder;
}

fs::path make_ring_folder(const fs::path& memory) {
  fs::path folder =
      memory / (std::string(kRingPrefix) + utc_stamp(std::time(nullptr)) + "-" + std::to_string(::getpid()));
  make_private(folder);
  return folder;
}

std::vector<fs::path> left_over_rings(const fs::path& memory) {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(memory, error)) {
    if (!entry.path().filename().string().starts_with(kRingPrefix) || entry.is_symlink(error)) continue;
    found.emplace_back(entry.last_write_time(error), entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> rings;
  rings.reserve(found.size());
  for (const auto& [time, path] : found) rings.push_back(path);
  return rings;
}

std::uint64_t ring_limit_bytes(const fs::path& memory, double max_mb) {
  constexpr double kMb = 1e6;
  return std::min(static_cast<std::uint64_t>(max_mb * kMb), recording::free_bytes(memory) / 2);
}

fs::path save_folder(const Config& config) {
  if (!config.black_box.directory.empty()) return config.black_box.directory;
  if (!config.output.directory.empty()) return fs::path(config.output.directory) / "blackbox";
  const fs::path state = service_folder("STATE_DIRECTORY");
  return state.empty() ? state : state / "blackbox";
}

std::string save_name(std::time_t utc_s, std::string_view reason) {
  constexpr std::size_t kMostLetters = 40;
  std::string word;
  for (const char c : reason.substr(0, kMostLetters)) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    word += upper ? static_cast<char>(c - 'A' + 'a') : plain ? c : '-';
  }
  return utc_stamp(utc_s) + "-" + (word.empty() ? "order" : word);
}

bool is_save_name(std::string_view name) {
  if (name.size() < kStampLength + 2 || name[8] != 'T' || name[15] != 'Z' || name[kStampLength] != '-') {
    return false;
  }
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return std::all_of(name.begin(), name.begin() + 8, is_digit) &&
         std::all_of(name.begin() + 9, name.begin() + 15, is_digit);
}

void delete_old_saves(const fs::path& folder, int keep, const fs::path& newest) {
  std::vector<fs::path> saves;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const bool ours = is_save_name(entry.path().filename().string()) && !entry.is_symlink(error) &&
                      fs::exists(entry.path() / recording::kManifestFile, error);
    if (ours && entry.path() != newest) saves.push_back(entry.path());
  }
  std::sort(saves.begin(), saves.end());
  const auto kept = static_cast<std::size_t>(std::max(keep - 1, 0));  // besides `newest`
  for (std::size_t i = 0; i + kept < saves.size(); ++i) fs::remove_all(saves[i], error);
}

}  // namespace isobar::black_box

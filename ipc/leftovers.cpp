// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/leftovers.hpp"

#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

namespace isobar::ipc {
namespace {

namespace fs = std::filesystem;

/// Fixed names of iceoryx and of its runtime in isobard.
constexpr std::array<const char*, 7> kFixedNames{
    Rendezvous::kManagement, Rendezvous::kLibraryLock, "/tmp/roudi",     "/tmp/roudi.lock",
    "/tmp/isobard",          "/tmp/isobard.lock",      Rendezvous::kLock};

std::optional<struct stat> status_at(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

std::string group_name(gid_t group) {
  const struct group* entry = ::getgrgid(group);  // NOLINT(concurrency-mt-unsafe): before the first thread
  return entry != nullptr ? entry->gr_name : std::to_string(group);
}

/// iceoryx names a data segment by its group. Only beside a management segment of the same user.
bool is_foreign_segment(const fs::path& path, const struct stat& status, uid_t broker_user) {
  return S_ISREG(status.st_mode) && status.st_uid == broker_user &&
         path.filename() == group_name(status.st_gid) && status.st_gid != ::getegid();
}

/// Socket or lock of an attached process, "isobar-dds-1234.lock", that has ended.
bool is_of_ended_process(const fs::path& path) {
  std::string name = path.filename();
  if (!name.starts_with("isobar-")) return false;
  if (name.ends_with(".lock")) name.resize(name.size() - std::string_view(".lock").size());
  const std::size_t dash = name.rfind('-');
  pid_t pid = 0;
  const char* end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data() + dash + 1, end, pid);
  return parsed.ec == std::errc{} && parsed.ptr == end && pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH;
}

std::vector<std::string> files_in(const char* folder) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) files.push_back(entry.path());
  return files;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Removes a file or an empty folder.
/// @return true when nothing is there any more
bool remove_entry(const std::string& path) {
  if (::unlink(path.c_str()) == 0 || errno == ENOENT) return true;
  return errno == EISDIR && ::rmdir(path.c_str()) == 0;
}

ObstructedError obstructed(const std::vector<std::string>& files, const std::string& reason) {
  const bool has_folder = std::any_of(files.begin(), files.end(), [](const std::string& file) {
    const auto status = status_at(file);
    return status && S_ISDIR(status->st_mode);
  });
  return ObstructedError("shared memory: " + joined(files) + " " + reason +
                         "; this user may not remove it, but: sudo rm " + (has_folder ? "-r " : "") +
                         joined(files));
}

}  // namespace

std::string owner_text(const std::string& path) {
  const auto status = status_at(path);
  if (!status) return "another user";
  const passwd* user = ::getpwuid(status->st_uid);  // NOLINT(concurrency-mt-unsafe): before the first thread
  return "user " + (user != nullptr ? std::string(user->pw_name) : std::to_string(status->st_uid));
}

std::string not_a_member(const std::string& path) {
  const auto status = status_at(path);
  const std::string group = status ? group_name(status->st_gid) : "isobar";
  return "isobard of " + owner_text(path) + " runs, but only members of its group " + group +
         " may attach: use sudo -u with its user, or sg " + group +
         " -c '...' as a member (sudo adduser NAME " + group + ")";
}

bool is_member_of_owner(const std::string& path) {
  const auto status = status_at(path);
  if (!status) return true;
  if (status->st_gid != ::getegid()) return false;
  const passwd* user = ::getpwuid(::geteuid());  // NOLINT(concurrency-mt-unsafe): before the first thread
  if (user == nullptr) return false;
  std::array<gid_t, 256> groups{};
  int count = groups.size();
  if (::getgrouplist(user->pw_name, user->pw_gid, groups.data(), &count) < 0) return false;
  return std::find(groups.begin(), groups.begin() + count, status->st_gid) != groups.begin() + count;
}

bool has_broker_of_owner(const std::string& path) {
  const auto file = status_at(path);
  const auto segment = status_at(Rendezvous::kManagement);
  return file && segment && file->st_uid == segment->st_uid;
}

void remove_obstacle(const std::string& path, const std::string& reason) {
  if (!remove_entry(path)) {
    throw obstructed({path}, "of " + owner_text(path) + " " + reason);
  }
}

void remove_files_of(const std::string& name) noexcept {
  if (!name.starts_with("isobar-") || name.find('/') != std::string::npos) return;  // the process chose it
  for (const char* ending : {"", ".lock"}) {
    static_cast<void>(::unlink(("/tmp/" + name + ending).c_str()) == 0);
  }
}

void remove_leftovers() {
  const auto management = status_at(Rendezvous::kManagement);
  std::vector<std::string> names(kFixedNames.begin(), kFixedNames.end());
  names.push_back("/dev/shm/" + group_name(::getegid()));  // the data segment
  std::vector<std::string> old;
  for (const std::string& path : names) {
    const auto status = status_at(path);
    if (status && status->st_uid != ::geteuid()) old.push_back(path);
  }
  for (const std::string& path : files_in("/dev/shm")) {
    const auto status = status_at(path);
    if (management && status && is_foreign_segment(path, *status, management->st_uid)) old.push_back(path);
  }
  std::vector<std::string> remaining;
  std::string owner;
  for (const std::string& path : old) {
    if (remove_entry(path)) continue;
    if (owner.empty()) owner = owner_text(path);
    remaining.push_back(path);
  }
  for (const std::string& path : files_in("/tmp")) {
    if (is_of_ended_process(path)) static_cast<void>(::unlink(path.c_str()) == 0);
  }
  if (!remaining.empty()) throw obstructed(remaining, "left by " + owner + " in the way of isobard");
}

}  // namespace isobar::ipc

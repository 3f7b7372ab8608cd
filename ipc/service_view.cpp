// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/service_view.hpp"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "core/errors.hpp"
#include "ipc/broker_lock.hpp"

namespace isobar::ipc {
namespace {

constexpr const char* kSharedMemory = "/dev/shm";
constexpr const char* kSockets = "/tmp";

ServiceError refused(const std::string& step) {
  return ServiceError("shared memory of isobard.service: " + step + ": " +
                      std::strerror(errno));  // NOLINT(concurrency-mt-unsafe)
}

ServiceError not_a_member(const std::string& user) {
  return ServiceError("shared memory of isobard.service is for root and group " + user +
                      ": use sudo, or `sg " + user + " -c '…'` as its member (sudo adduser NAME " + user +
                      ")");
}

std::optional<struct stat> status_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

bool same_place(const std::string& path, const std::string& other) {
  const auto a = status_of(path);
  const auto b = status_of(other);
  return a && b && a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/// Whether an isobard runs that this process reaches as it is.
bool reaches_isobard() {
  try {
    static_cast<void>(BrokerWatch::find(std::chrono::milliseconds(0)));
    return true;
  } catch (const ServiceError&) {
    return false;
  }
}

void write_line(const char* path, const std::string& line) {
  const int descriptor = ::open(path, O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) throw refused(path);
  const bool written = ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  ::close(descriptor);
  if (!written) throw refused(path);
}

/// A mount namespace for a process without rights: inside a user namespace in which it is itself.
void unshare_as_member(gid_t group) {
  const uid_t user = ::geteuid();
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) throw refused("a namespace of its own");
  write_line("/proc/self/setgroups", "deny");
  write_line("/proc/self/uid_map", std::to_string(user) + " " + std::to_string(user) + " 1");
  write_line("/proc/self/gid_map", std::to_string(group) + " " + std::to_string(group) + " 1");
}

void bind(const std::string& from, const char* to) {
  if (::mount(from.c_str(), to, nullptr, MS_BIND | MS_REC, nullptr) != 0) throw refused(from);
}

void become(const passwd& user) {
  const bool done = ::initgroups(user.pw_name, user.pw_gid) == 0 &&
                    ::setresgid(user.pw_gid, user.pw_gid, user.pw_gid) == 0 &&
                    ::setresuid(user.pw_uid, user.pw_uid, user.pw_uid) == 0;
  if (!done) throw refused(std::string("user ") + user.pw_name);
}

}  // namespace

void enter_service_view(const ServiceFolders& service) {
  const bool is_root = ::geteuid() == 0;
  if (same_place(service.shared_memory, kSharedMemory)) return;
  if (!status_of(service.shared_memory + "/isobar.lock")) {
    if (errno != EACCES || reaches_isobard()) return;
    throw not_a_member(service.user);
  }
  if (reaches_isobard()) return;
  const passwd* user = ::getpwnam(service.user.c_str());  // NOLINT(concurrency-mt-unsafe)
  if (user == nullptr) throw refused("user " + service.user);
  if (is_root) {
    if (::unshare(CLONE_NEWNS) != 0) throw refused("a namespace of its own");
  } else {
    // iceoryx takes the rights of the effective group, which only sg(1) sets.
    if (::getegid() != user->pw_gid) throw not_a_member(service.user);
    unshare_as_member(user->pw_gid);
  }
  if (::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) throw refused("/");
  bind(service.shared_memory, kSharedMemory);
  bind(service.sockets, kSockets);
  if (is_root) become(*user);
}

}  // namespace isobar::ipc

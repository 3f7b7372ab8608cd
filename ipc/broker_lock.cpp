// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/broker_lock.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "ipc/leftovers.hpp"
#include "ipc/lock_bytes.hpp"
#include "ipc/lock_table.hpp"

namespace isobar::ipc {
namespace {

constexpr const char* kLockPath = Rendezvous::kLock;
/// Only the owner's group may attach.
constexpr mode_t kLockMode = 0640;

std::string errno_text() { return std::strerror(errno); }  // NOLINT(concurrency-mt-unsafe)

/// Owner of a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return value_; }

 private:
  int value_;
};

std::string process_text(const HeldLock& held) {
  return held.pid > 0 ? "process " + std::to_string(held.pid) : "another process";
}

/// Refuses to start beside another program that runs RouDi, which would end this process inside the library.
/// A lock without a broker behind it is an obstacle that another user made.
void require_free_library_lock() {
  const char* path = Rendezvous::kLibraryLock;
  std::optional<HeldLock> held = find_lock(path, /*is_flock=*/true);
  if (!held) {
    const Descriptor file(::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0 || ::flock(file.get(), LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    held.emplace();
  }
  if (has_broker_of_owner(path)) {
    throw ServiceError("another program serves iceoryx on this machine (it holds " + std::string(path) +
                       "); stop it first: iox-roudi or a second isobard");
  }
  remove_obstacle(path, "is locked by " + process_text(*held));
}

/// Opens the lock file of an owner that has announced itself, with the shared lock of an attached process.
/// @return descriptor; -1: there is no such owner
int open_announced(std::uint64_t& instance) {
  const int descriptor = ::open(kLockPath, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    if (errno == EACCES) throw ServiceError(not_a_member(kLockPath));
    return -1;
  }
  // Lock first, then number: a number read while the third byte is locked belongs to the live owner.
  if (lock_byte(descriptor, LockByte::kAttached) && is_byte_locked(descriptor, LockByte::kAnnounced) &&
      read_instance(descriptor, instance)) {
    return descriptor;
  }
  ::close(descriptor);
  return -1;
}

bool is_held(const char* path) {
  if (find_lock(path, /*is_flock=*/false)) return true;
  const Descriptor file(::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // where /proc/locks is hidden
  return file.get() >= 0 && is_byte_locked(file.get(), LockByte::kOwner);
}

ServiceError another_isobard() {
  return ServiceError("another isobard is running on this machine, of " + owner_text(kLockPath) +
                      " (it holds " + kLockPath + "); stop it first");
}

/// Clears the place of the lock file, at which there is a file of another user.
/// @throws ServiceError when an isobard of that user runs
/// @throws ObstructedError when the file cannot be removed
void clear_foreign_lock_file() {
  if (!is_held(kLockPath)) {
    require_free_library_lock();
    remove_leftovers();
    return;
  }
  if (has_broker_of_owner(kLockPath)) throw another_isobard();
  const auto held = find_lock(kLockPath, /*is_flock=*/false);
  remove_obstacle(kLockPath, "is locked by " + process_text(held.value_or(HeldLock{})));
}

bool is_own(int descriptor) noexcept {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_uid == ::geteuid();
}

/// Opens the lock file for writing; creates it if there is none.
/// @return descriptor; -1: the file of another user was in the way and is gone
int open_lock_file() {
  // Without O_CREAT on a file that exists: fs.protected_regular, which Debian sets, refuses it in /dev/shm.
  int descriptor = ::open(kLockPath, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0 && errno == ENOENT) {
    descriptor = ::open(kLockPath, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kLockMode);
  }
  const bool is_no_file = descriptor < 0 && (errno == ELOOP || errno == EISDIR);
  if (descriptor < 0 && !is_no_file && errno != EACCES && errno != EEXIST) {
    throw ServiceError(std::string(kLockPath) + ": cannot be opened: " + errno_text());
  }
  if (descriptor >= 0 && is_own(descriptor)) {
    static_cast<void>(::fchmod(descriptor, kLockMode) == 0);  // whatever the umask
    return descriptor;
  }
  if (descriptor >= 0) ::close(descriptor);
  clear_foreign_lock_file();
  if (is_no_file) remove_obstacle(kLockPath, "is no file");  // also one of this user
  return -1;
}

/// Opens the lock file and takes the owner's lock.
/// @throws ServiceError when another isobard has it, or when the file cannot be opened
/// @throws ObstructedError when a file or a lock of another user is in the way
int open_and_lock() {
  int descriptor = open_lock_file();
  while (descriptor < 0) descriptor = open_lock_file();
  if (!lock_byte(descriptor, LockByte::kOwner)) {
    ::close(descriptor);
    throw another_isobard();
  }
  return descriptor;
}

/// Whether kLockPath still names the opened file.
bool is_in_place(int descriptor) noexcept {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(kLockPath, &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

BrokerLock BrokerLock::acquire() {
  int descriptor = open_and_lock();
  while (!is_in_place(descriptor)) {  // its owner removed it between open() and the lock
    ::close(descriptor);
    descriptor = open_and_lock();
  }
  BrokerLock lock(descriptor);
  require_free_library_lock();
  remove_leftovers();
  if (::ftruncate(descriptor, 0) != 0) {
    throw ServiceError(std::string(kLockPath) + ": cannot be written: " + errno_text());
  }
  return lock;
}

void BrokerLock::announce() {
  std::uint64_t instance = 0;
  while (instance == 0) {
    if (::getrandom(&instance, sizeof(instance), 0) != static_cast<ssize_t>(sizeof(instance))) {
      throw ServiceError("getrandom: " + errno_text());
    }
  }
  if (!announce_instance(descriptor_, instance)) {
    throw ServiceError(std::string(kLockPath) + ": cannot be written: " + errno_text());
  }
}

void BrokerLock::withdraw(std::chrono::milliseconds timeout) noexcept {
  static_cast<void>(::ftruncate(descriptor_, 0) == 0);
  for (const int file : removed_) static_cast<void>(::ftruncate(file, 0) == 0);
  const auto has_attached = [](int file) { return is_byte_locked(file, LockByte::kAttached); };
  const auto any_attached = [&] {
    return has_attached(descriptor_) || std::any_of(removed_.begin(), removed_.end(), has_attached);
  };
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  // Polling, because fcntl(2) has no lock wait with a timeout. Only at the end of the program.
  while (any_attached() && std::chrono::steady_clock::now() < deadline) {
    ::poll(nullptr, 0, 10);
  }
}

void BrokerLock::put_back() {
  if (is_in_place(descriptor_)) return;
  const int descriptor = ::open(kLockPath, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kLockMode);
  std::uint64_t instance = 0;
  if (descriptor < 0 || !lock_byte(descriptor, LockByte::kOwner) || !read_instance(descriptor_, instance) ||
      !announce_instance(descriptor, instance)) {
    if (descriptor >= 0) ::close(descriptor);
    return;
  }
  static_cast<void>(::fchmod(descriptor, kLockMode) == 0);
  // The old file lives on: attached processes hold their locks on it.
  removed_.push_back(std::exchange(descriptor_, descriptor));
}

BrokerLock::BrokerLock(BrokerLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), removed_(std::move(other.removed_)) {}

BrokerLock::~BrokerLock() {
  if (descriptor_ >= 0) {
    // Unlinked while locked, so that an isobard of another user can start next. If unlinking fails, the stale
    // instance number is harmless without the lock.
    static_cast<void>(::ftruncate(descriptor_, 0) == 0);
    if (is_in_place(descriptor_)) static_cast<void>(::unlink(kLockPath) == 0);
    ::close(descriptor_);
    for (const int file : removed_) ::close(file);
  }
}

BrokerWatch BrokerWatch::find(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const Descriptor changes(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK));
  // The watch precedes the first attempt, so that a start in between is not missed.
  static_cast<void>(::inotify_add_watch(changes.get(), "/dev/shm", IN_CREATE | IN_MODIFY));
  for (;;) {
    std::uint64_t instance = 0;
    const int descriptor = open_announced(instance);
    if (descriptor >= 0) {
      return {descriptor, instance};
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) {
      throw ServiceError("isobard is not running: no shared memory to attach to");
    }
    // At most one second, in case inotify is unavailable.
    pollfd waiting{changes.get(), POLLIN, 0};
    static_cast<void>(::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000))));
    std::array<char, 4096> events{};
    while (::read(changes.get(), events.data(), events.size()) > 0) {
    }
  }
}

BrokerWatch::BrokerWatch(BrokerWatch&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), instance_(other.instance_) {}

BrokerWatch::~BrokerWatch() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

bool BrokerWatch::alive() const noexcept {
  std::uint64_t instance = 0;
  return is_byte_locked(descriptor_, LockByte::kAnnounced) && read_instance(descriptor_, instance) &&
         instance == instance_;
}

}  // namespace isobar::ipc

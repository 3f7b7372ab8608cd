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
#include <string>
#include <utility>

#include "core/errors.hpp"

namespace isobar::ipc {
namespace {

constexpr const char* kLockPath = "/dev/shm/isobar.lock";
/// iceoryx's own lock file, held by any program that runs RouDi.
constexpr const char* kLibraryLockPath = "/tmp/iox-unique-roudi.lock";

/// Byte ranges of the lock file: the owner has an exclusive lock on the first byte, each attached process a
/// shared lock on the second.
constexpr off_t kOwnerByte = 0;
constexpr off_t kAttachedByte = 1;

struct flock lock_of(short type, off_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

std::string errno_text() { return std::strerror(errno); }  // NOLINT(concurrency-mt-unsafe)

/// Whether another program runs RouDi on this machine. Starting a second one would end this process inside
/// the library.
bool library_lock_is_held() {
  const int descriptor = ::open(kLibraryLockPath, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return false;
  }
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

bool read_instance(int descriptor, std::uint64_t& instance) noexcept {
  return ::pread(descriptor, &instance, sizeof(instance), 0) == static_cast<ssize_t>(sizeof(instance)) &&
         instance != 0;
}

bool conflicts(int descriptor, struct flock query) noexcept {
  return ::fcntl(descriptor, F_OFD_GETLK, &query) == 0 && query.l_type != F_UNLCK;
}

bool has_owner(int descriptor) noexcept { return conflicts(descriptor, lock_of(F_RDLCK, kOwnerByte)); }

bool has_attached(int descriptor) noexcept { return conflicts(descriptor, lock_of(F_WRLCK, kAttachedByte)); }

/// Opens the lock file of an owner that has announced itself, with the shared lock of an attached process.
/// @return descriptor; -1: there is no such owner
int open_announced(std::uint64_t& instance) {
  const int descriptor = ::open(kLockPath, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return -1;
  }
  // Lock first, then number: a number read while the lock is held belongs to the live owner.
  struct flock attached = lock_of(F_RDLCK, kAttachedByte);
  if (::fcntl(descriptor, F_OFD_SETLK, &attached) == 0 && has_owner(descriptor) &&
      read_instance(descriptor, instance)) {
    return descriptor;
  }
  ::close(descriptor);
  return -1;
}

/// Opens the lock file and takes the owner's lock.
/// @throws ServiceError when another process has it, or when the file cannot be opened
int open_and_lock() {
  // First without O_CREAT: fs.protected_regular, which Debian sets, refuses O_CREAT on a file that a killed
  // isobard of another user left behind.
  int descriptor = ::open(kLockPath, O_RDWR | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT) {
    descriptor = ::open(kLockPath, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  }
  if (descriptor < 0) {
    throw ServiceError(std::string(kLockPath) + ": cannot be opened: " + errno_text());
  }
  struct flock request = lock_of(F_WRLCK, kOwnerByte);
  if (::fcntl(descriptor, F_OFD_SETLK, &request) != 0) {
    ::close(descriptor);
    throw ServiceError("another isobard is running on this machine (it holds " + std::string(kLockPath) +
                       "); stop it first");
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

/// Owner of a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) {
      ::close(value_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return value_; }

 private:
  int value_;
};

}  // namespace

BrokerLock BrokerLock::acquire() {
  int descriptor = open_and_lock();
  while (!is_in_place(descriptor)) {  // its owner removed it between open() and the lock
    ::close(descriptor);
    descriptor = open_and_lock();
  }
  BrokerLock lock(descriptor);
  if (library_lock_is_held()) {
    throw ServiceError("another program serves iceoryx on this machine (it holds " +
                       std::string(kLibraryLockPath) + "); stop it first: iox-roudi or a second isobard");
  }
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
  if (::pwrite(descriptor_, &instance, sizeof(instance), 0) != static_cast<ssize_t>(sizeof(instance))) {
    throw ServiceError(std::string(kLockPath) + ": cannot be written: " + errno_text());
  }
}

void BrokerLock::withdraw(std::chrono::milliseconds timeout) noexcept {
  static_cast<void>(::ftruncate(descriptor_, 0) == 0);
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  // Polling, because fcntl(2) has no lock wait with a timeout. Only at the end of the program.
  while (has_attached(descriptor_) && std::chrono::steady_clock::now() < deadline) {
    ::poll(nullptr, 0, 10);
  }
}

BrokerLock::BrokerLock(BrokerLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

BrokerLock::~BrokerLock() {
  if (descriptor_ >= 0) {
    // Unlinked while locked, so that an isobard of another user can start next. If unlinking fails, the stale
    // instance number is harmless without the lock.
    static_cast<void>(::ftruncate(descriptor_, 0) == 0);
    static_cast<void>(::unlink(kLockPath) == 0);
    ::close(descriptor_);
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
  return has_owner(descriptor_) && read_instance(descriptor_, instance) && instance == instance_;
}

}  // namespace isobar::ipc

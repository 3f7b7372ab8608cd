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
/// The lock of iceoryx itself, held by any program with a RouDi inside.
constexpr const char* kLibraryLockPath = "/tmp/iox-unique-roudi.lock";

/// The holder locks the first byte against all, those who attach share the second.
constexpr off_t kHolderByte = 0;
constexpr off_t kAttachedByte = 1;

struct flock lock_of(short type, off_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

std::string reason() { return std::strerror(errno); }  // NOLINT(concurrency-mt-unsafe)

/// Does a process that is not isobard serve iceoryx here? That would end this process inside the library.
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

bool is_held(int descriptor) noexcept {
  struct flock query = lock_of(F_RDLCK, kHolderByte);
  return ::fcntl(descriptor, F_OFD_GETLK, &query) == 0 && query.l_type != F_UNLCK;
}

bool is_attached_to(int descriptor) noexcept {
  struct flock query = lock_of(F_WRLCK, kAttachedByte);
  return ::fcntl(descriptor, F_OFD_GETLK, &query) == 0 && query.l_type != F_UNLCK;
}

/// A holder that has announced itself; -1: none.
int open_announced(std::uint64_t& instance) {
  const int descriptor = ::open(kLockPath, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return -1;
  }
  // The lock before the number: a number that is read after the lock was seen is never that of a dead holder.
  struct flock attached = lock_of(F_RDLCK, kAttachedByte);
  if (::fcntl(descriptor, F_OFD_SETLK, &attached) == 0 && is_held(descriptor) &&
      read_instance(descriptor, instance)) {
    return descriptor;
  }
  ::close(descriptor);
  return -1;
}

/// Opens and locks the file, or throws.
int open_and_lock() {
  // A file that a killed isobard of another user left behind may be opened, but not with O_CREAT: Debian sets
  // fs.protected_regular.
  int descriptor = ::open(kLockPath, O_RDWR | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT) {
    descriptor = ::open(kLockPath, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  }
  if (descriptor < 0) {
    throw ServiceError(std::string(kLockPath) + ": cannot be opened: " + reason());
  }
  struct flock request = lock_of(F_WRLCK, kHolderByte);
  if (::fcntl(descriptor, F_OFD_SETLK, &request) != 0) {
    ::close(descriptor);
    throw ServiceError("another isobard is running on this machine (it holds " + std::string(kLockPath) +
                       "); stop it first");
  }
  return descriptor;
}

/// Is this still the file that others find under the lock's name?
bool is_in_place(int descriptor) noexcept {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(kLockPath, &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

/// Closes a descriptor at the end of a block.
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
  while (!is_in_place(descriptor)) {  // its holder removed it between our opening and our lock
    ::close(descriptor);
    descriptor = open_and_lock();
  }
  BrokerLock lock(descriptor);
  if (library_lock_is_held()) {
    throw ServiceError("another program serves iceoryx on this machine (it holds " +
                       std::string(kLibraryLockPath) + "); stop it first: iox-roudi or a second isobard");
  }
  if (::ftruncate(descriptor, 0) != 0) {
    throw ServiceError(std::string(kLockPath) + ": cannot be written: " + reason());
  }
  return lock;
}

void BrokerLock::announce() {
  std::uint64_t instance = 0;
  while (instance == 0) {
    if (::getrandom(&instance, sizeof(instance), 0) != static_cast<ssize_t>(sizeof(instance))) {
      throw ServiceError("no random numbers: " + reason());
    }
  }
  if (::pwrite(descriptor_, &instance, sizeof(instance), 0) != static_cast<ssize_t>(sizeof(instance))) {
    throw ServiceError(std::string(kLockPath) + ": cannot be written: " + reason());
  }
}

void BrokerLock::withdraw(std::chrono::milliseconds patience) noexcept {
  static_cast<void>(::ftruncate(descriptor_, 0) == 0);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  // Locks cannot be waited for with a limit; this is the end of the program, not its work.
  while (is_attached_to(descriptor_) && std::chrono::steady_clock::now() < deadline) {
    ::poll(nullptr, 0, 10);
  }
}

BrokerLock::BrokerLock(BrokerLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

BrokerLock::~BrokerLock() {
  if (descriptor_ >= 0) {
    // Removed while it is locked, so that an isobard of another user can start next. A failure leaves the
    // number of a dead holder behind, which the lock's absence makes harmless.
    static_cast<void>(::ftruncate(descriptor_, 0) == 0);
    static_cast<void>(::unlink(kLockPath) == 0);
    ::close(descriptor_);
  }
}

BrokerWatch BrokerWatch::find(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const Descriptor changes(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK));
  // Watched before the first look, so that a start in between is not missed.
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
      throw ServiceError("isobard is not running: there is no shared memory to attach to");
    }
    // A second at most, for machines where inotify is refused.
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
  return is_held(descriptor_) && read_instance(descriptor_, instance) && instance == instance_;
}

}  // namespace isobar::ipc

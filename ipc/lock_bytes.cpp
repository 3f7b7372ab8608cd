// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/lock_bytes.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace isobar::ipc {
namespace {

struct flock lock_of(short type, LockByte byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(byte);
  lock.l_len = 1;
  return lock;
}

bool is_shared(LockByte byte) { return byte == LockByte::kAttached; }

}  // namespace

bool lock_byte(int descriptor, LockByte byte) noexcept {
  struct flock request = lock_of(is_shared(byte) ? F_RDLCK : F_WRLCK, byte);
  return ::fcntl(descriptor, F_OFD_SETLK, &request) == 0;
}

bool is_byte_locked(int descriptor, LockByte byte) noexcept {
  struct flock query = lock_of(is_shared(byte) ? F_WRLCK : F_RDLCK, byte);
  return ::fcntl(descriptor, F_OFD_GETLK, &query) == 0 && query.l_type != F_UNLCK;
}

bool read_instance(int descriptor, std::uint64_t& instance) noexcept {
  return ::pread(descriptor, &instance, sizeof(instance), 0) == static_cast<ssize_t>(sizeof(instance)) &&
         instance != 0;
}

bool announce_instance(int descriptor, std::uint64_t instance) noexcept {
  return lock_byte(descriptor, LockByte::kAnnounced) &&
         ::pwrite(descriptor, &instance, sizeof(instance), 0) == static_cast<ssize_t>(sizeof(instance));
}

}  // namespace isobar::ipc

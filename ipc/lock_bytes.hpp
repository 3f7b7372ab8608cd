// SPDX-License-Identifier: BSD-3-Clause
// What is in the lock file of shared memory: locked bytes (fcntl(2), open file description locks) and the instance
// number of the owner. The kernel releases the locks of a process that ends.
#pragma once

#include <cstdint>

namespace isobar::ipc {

/// The bytes of the lock file that are locked.
enum class LockByte : std::uint8_t {
  kOwner = 0,     ///< by the owner alone
  kAttached = 1,  ///< by all attached processes together
  /// By the owner, once the number in the file is its own: until then it may be that of an owner that was killed,
  /// and a process that attached by it would restart as soon as the number changes.
  kAnnounced = 2,
};

/// Takes the lock of a byte, shared for LockByte::kAttached and exclusive for the others. Any thread.
/// @return false when another process has it
[[nodiscard]] bool lock_byte(int descriptor, LockByte byte) noexcept;

/// Whether another open file has locked the byte. Any thread.
[[nodiscard]] bool is_byte_locked(int descriptor, LockByte byte) noexcept;

/// @return false when there is no number in the file
[[nodiscard]] bool read_instance(int descriptor, std::uint64_t& instance) noexcept;

/// Announces the owner: locks LockByte::kAnnounced, then writes its number. In this order, because those who wait
/// for an owner look at the file when it is written.
/// @return false when it cannot be written
[[nodiscard]] bool announce_instance(int descriptor, std::uint64_t instance) noexcept;

}  // namespace isobar::ipc

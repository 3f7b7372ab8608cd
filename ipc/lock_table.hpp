// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace isobar::ipc {

/// A lock on a file, as the kernel lists it in /proc/locks: visible also for files that this user may not open.
struct HeldLock {
  pid_t pid = -1;  ///< -1: unknown, as for locks of an open file description
};

/// The first lock that any process holds on this file; none where /proc/locks is hidden.
/// @param is_flock locks of flock(2), else those of fcntl(2)
[[nodiscard]] std::optional<HeldLock> find_lock(const std::string& path, bool is_flock);

}  // namespace isobar::ipc

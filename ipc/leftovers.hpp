// SPDX-License-Identifier: BSD-3-Clause
// Files of shared memory that other users own: left by a process that was killed, or made to be in the way.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"

namespace isobar::ipc {

/// Something is in the way that may pass: a file that another user owns or locks. The text names all files and
/// the command that removes them.
class ObstructedError : public ServiceError {
 public:
  using ServiceError::ServiceError;
};

/// Folders and names of the rendezvous.
struct Rendezvous {
  static constexpr const char* kLock = "/dev/shm/isobar.lock";
  static constexpr const char* kManagement = "/dev/shm/iceoryx_mgmt";
  /// iceoryx's own lock file, held by any program that runs RouDi.
  static constexpr const char* kLibraryLock = "/tmp/iox-unique-roudi.lock";
};

/// Removes what killed programs left: files of other users in the way of a new broker, segments of other
/// groups, and sockets of attached processes that have ended. Call it while holding the broker's lock and
/// while no other program holds the library's.
/// @throws ObstructedError naming all files that this user may not remove
void remove_leftovers();

/// Removes the socket and the lock of an attached process that has ended.
/// @param name of its runtime, "isobar-dds-1234"
void remove_files_of(const std::string& name) noexcept;

/// Removes a file that another user made in the way of this one.
/// @param reason what it is, "is locked by process 1234"
/// @throws ObstructedError when this user may not remove it
void remove_obstacle(const std::string& path, const std::string& reason);

/// True if the owner of this file has a broker, alive or killed: its segment exists.
[[nodiscard]] bool has_broker_of_owner(const std::string& path);

/// Why this user may not attach to the isobard that owns the file, and the remedy.
[[nodiscard]] std::string not_a_member(const std::string& path);

/// Whether this process has the rights that attaching needs: the file's group as its effective group, of which
/// its user is a member. iceoryx fails without a message, or worse, without them.
[[nodiscard]] bool is_member_of_owner(const std::string& path);

/// "user nobody", by the owner of a file.
[[nodiscard]] std::string owner_text(const std::string& path);

}  // namespace isobar::ipc

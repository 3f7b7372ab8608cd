// SPDX-License-Identifier: BSD-3-Clause
// Ownership of this machine's shared memory: a lock file in /dev/shm. The kernel releases the lock when the
// owner ends, even by SIGKILL, so a held lock always means a live owner. A random instance number in the file
// distinguishes successive owners.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace isobar::ipc {

/// The owner's side.
class BrokerLock {
 public:
  /// Removes what killed programs of whatever user left, as far as this user may.
  /// @throws ServiceError when another process owns the shared memory, or when the file cannot be written
  /// @throws ObstructedError when files or locks of another user are in the way
  [[nodiscard]] static BrokerLock acquire();
  ~BrokerLock();
  BrokerLock(BrokerLock&& other) noexcept;
  BrokerLock& operator=(BrokerLock&&) = delete;
  BrokerLock(const BrokerLock&) = delete;
  BrokerLock& operator=(const BrokerLock&) = delete;

  /// Writes the instance number: from now on BrokerWatch::find() succeeds.
  /// @throws ServiceError when the file cannot be written
  void announce();

  /// Makes the lock file again if somebody has removed it: attaching finds a live owner, and no second owner
  /// can start. Attached processes keep the old one.
  void put_back();

  /// Clears the instance number, then waits until every attached process has detached: removing shared memory
  /// that is in use can crash both sides.
  /// @param timeout longest wait
  void withdraw(std::chrono::milliseconds timeout) noexcept;

 private:
  explicit BrokerLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
  std::vector<int> removed_;  // lock files that were removed by somebody
};

/// The side of an attached process. While it exists, the owner counts this process as attached.
class BrokerWatch {
 public:
  /// Waits until an owner has announced itself.
  /// @param timeout longest wait; 0: one attempt
  /// @throws ServiceError when there is none within the timeout, or at once when this user may not attach
  [[nodiscard]] static BrokerWatch find(std::chrono::milliseconds timeout);
  ~BrokerWatch();
  BrokerWatch(BrokerWatch&& other) noexcept;
  BrokerWatch& operator=(BrokerWatch&&) = delete;
  BrokerWatch(const BrokerWatch&) = delete;
  BrokerWatch& operator=(const BrokerWatch&) = delete;

  /// False once that owner has ended or withdrawn, even if another one has started since.
  [[nodiscard]] bool alive() const noexcept;

 private:
  BrokerWatch(int descriptor, std::uint64_t instance) : descriptor_(descriptor), instance_(instance) {}
  int descriptor_;
  std::uint64_t instance_;
};

}  // namespace isobar::ipc

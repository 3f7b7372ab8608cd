// SPDX-License-Identifier: BSD-3-Clause
// Who holds the shared memory of this machine: a lock on a file beside it. The kernel gives the lock back
// when its holder dies in any way, so that it never lies; an instance number in the file tells one holder
// from the next.
#pragma once

#include <chrono>
#include <cstdint>

namespace isobar::ipc {

/// The holder's side.
class BrokerLock {
 public:
  /// @throws ServiceError another process holds it, or the file cannot be written
  [[nodiscard]] static BrokerLock acquire();
  ~BrokerLock();
  BrokerLock(BrokerLock&& other) noexcept;
  BrokerLock& operator=(BrokerLock&&) = delete;
  BrokerLock(const BrokerLock&) = delete;
  BrokerLock& operator=(const BrokerLock&) = delete;

  /// Says that others may attach. Until then a BrokerWatch waits.
  /// @throws ServiceError the file cannot be written
  void announce();

  /// Says that the shared memory is about to go, and waits until nobody who attached is left, `patience` at
  /// most: memory that is taken apart while others work on it can crash both sides.
  void withdraw(std::chrono::milliseconds patience) noexcept;

 private:
  explicit BrokerLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// The side of those who attach. The holder sees that this exists.
class BrokerWatch {
 public:
  /// Waits until a holder has announced itself, `timeout` at most (0: looks once).
  /// @throws ServiceError there was none in time
  [[nodiscard]] static BrokerWatch find(std::chrono::milliseconds timeout);
  ~BrokerWatch();
  BrokerWatch(BrokerWatch&& other) noexcept;
  BrokerWatch& operator=(BrokerWatch&&) = delete;
  BrokerWatch(const BrokerWatch&) = delete;
  BrokerWatch& operator=(const BrokerWatch&) = delete;

  /// False once that holder has gone, even if another has followed.
  [[nodiscard]] bool alive() const noexcept;

 private:
  BrokerWatch(int descriptor, std::uint64_t instance) : descriptor_(descriptor), instance_(instance) {}
  int descriptor_;
  std::uint64_t instance_;
};

}  // namespace isobar::ipc

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>

#include "ipc/channel.hpp"

namespace isobar::ipc {

/// Blocks until any of its subscribers has a message. wait() and wait_for() belong to one thread; stop() and
/// wake() are safe from any. Allocates nothing after construction.
class Waiter {
 public:
  static constexpr std::size_t kMaxSubscribers = 15;

  /// Usage: Waiter waiter({&imu.raw(), &wheel.raw()}). The subscribers must outlive the waiter.
  /// @throws ServiceError when there are more than kMaxSubscribers, or when the library refuses one
  explicit Waiter(std::initializer_list<detail::RawSubscriber*> subscribers);
  ~Waiter();
  Waiter(const Waiter&) = delete;
  Waiter& operator=(const Waiter&) = delete;

  enum class Event : std::uint8_t { kData, kTimeout, kStopped };

  /// Level-triggered: returns kData at once while a message is waiting.
  [[nodiscard]] Event wait() noexcept;
  [[nodiscard]] Event wait_for(std::chrono::nanoseconds timeout) noexcept;

  /// Wakes the waiting thread; every later wait returns kStopped at once.
  void stop() noexcept;
  /// Wakes the waiting thread once. Its wait returns kData, possibly without a message.
  void wake() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isobar::ipc

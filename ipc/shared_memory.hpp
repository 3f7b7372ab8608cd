// SPDX-License-Identifier: BSD-3-Clause
// Messages between threads and processes of one machine, through shared memory and without copies. This pair
// of files is the only code that names iceoryx.
//
// One process, isobard, holds the Broker; others hold an Attachment. Only while one of the two lives may
// Publishers, Subscribers and Waiters exist; all of them must be gone before it goes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <new>
#include <utility>

#include "ipc/topics.hpp"

namespace isobar::ipc {

/// Faults that the shared-memory library reported and survived, since the start of this process.
[[nodiscard]] std::uint64_t library_fault_count() noexcept;

/// What is done instead of ending the process with code 69 when the library reports a fault that it cannot
/// survive. The action must not return and must not use the library: it may replace the process by exec.
using FatalAction = void (*)();
void set_fatal_action(FatalAction action) noexcept;

/// Creates the shared memory and serves the processes that attach, with threads of its own.
class Broker {
 public:
  /// @throws ServiceError another isobard runs on this machine; /dev/shm is too small (says how many MB are
  ///         needed and free); shared memory is refused.
  Broker();
  /// Attached processes go on living, but get no more messages. Waits up to 2 s until they have noticed and
  /// left.
  ~Broker();
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  /// Free space that a Broker needs in /dev/shm [bytes].
  [[nodiscard]] static std::uint64_t needed_bytes() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Joins the shared memory of a running isobard.
class Attachment {
 public:
  /// Waits until isobard runs, `timeout` at most (0: looks once).
  /// @param name what this process calls itself, at most 60 characters of a file name; its process id is
  /// added
  /// @throws ServiceError no isobard was there in time, or it refuses
  Attachment(const char* name, std::chrono::milliseconds timeout);
  ~Attachment();
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;

  /// False once the isobard that was joined has gone, even if another one has started meanwhile. From then on
  /// nothing arrives any more, and only a new process can attach again. To be asked at least twice a second:
  /// an isobard that ends waits for those who are attached. Costs a few system calls.
  [[nodiscard]] bool broker_alive() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class Waiter;

namespace detail {

/// Publisher of untyped chunks. Belongs to one thread.
class RawPublisher {
 public:
  RawPublisher(const char* topic, std::uint32_t history, std::size_t bytes, std::size_t alignment);
  ~RawPublisher();
  RawPublisher(const RawPublisher&) = delete;
  RawPublisher& operator=(const RawPublisher&) = delete;

  void* loan() noexcept;  ///< nullptr: no chunk is free
  void publish(void* chunk) noexcept;
  void discard(void* chunk) noexcept;
  [[nodiscard]] bool has_subscribers() const noexcept;
  [[nodiscard]] std::uint64_t loan_failures() const noexcept { return loan_failures_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::uint64_t loan_failures_ = 0;
};

/// Subscriber of untyped chunks. Belongs to one thread.
class RawSubscriber {
 public:
  RawSubscriber(const char* topic, std::uint32_t depth, std::uint32_t history, std::size_t bytes);
  ~RawSubscriber();
  RawSubscriber(const RawSubscriber&) = delete;
  RawSubscriber& operator=(const RawSubscriber&) = delete;

  const void* take() noexcept;  ///< the oldest waiting chunk, nullptr: none
  void release(const void* chunk) noexcept;
  [[nodiscard]] bool has_data() const noexcept;
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
  [[nodiscard]] std::uint64_t rejected() const noexcept { return rejected_; }

 private:
  friend class isobar::ipc::Waiter;
  struct Impl;
  void count_gap(const void* chunk) noexcept;

  std::unique_ptr<Impl> impl_;
  std::uint64_t dropped_ = 0;
  std::uint64_t rejected_ = 0;
};

}  // namespace detail

/// Writes a topic. Belongs to one thread. Allocates nothing after construction.
template <class Payload>
class Publisher {
 public:
  explicit Publisher(const Topic<Payload>& topic)
      : raw_(topic.name, topic.history, sizeof(Payload), alignof(Payload)) {}

  /// A default-constructed message in shared memory, to be filled and then published or discarded; 8 at most
  /// at a time. nullptr when no chunk is free, which is counted.
  [[nodiscard]] Payload* loan() noexcept {
    void* chunk = raw_.loan();
    return chunk == nullptr ? nullptr : new (chunk) Payload;
  }
  void publish(Payload* message) noexcept { raw_.publish(message); }
  void discard(Payload* message) noexcept { raw_.discard(message); }

  /// Loans, copies, publishes. For small messages. False when no chunk is free, which is counted.
  bool send(const Payload& message) noexcept {
    void* chunk = raw_.loan();
    if (chunk == nullptr) {
      return false;
    }
    raw_.publish(new (chunk) Payload(message));
    return true;
  }

  [[nodiscard]] bool has_subscribers() const noexcept { return raw_.has_subscribers(); }
  [[nodiscard]] std::uint64_t loan_failures() const noexcept { return raw_.loan_failures(); }

 private:
  detail::RawPublisher raw_;
};

/// A received message, given back when this goes. Must not outlive its Subscriber. Same thread.
template <class Payload>
class Received {
 public:
  Received() = default;
  Received(detail::RawSubscriber* from, const void* chunk) noexcept
      : from_(from), message_(static_cast<const Payload*>(chunk)) {}
  ~Received() { reset(); }
  Received(Received&& other) noexcept
      : from_(other.from_), message_(std::exchange(other.message_, nullptr)) {}
  Received& operator=(Received&& other) noexcept {
    if (this != &other) {
      reset();
      from_ = other.from_;
      message_ = std::exchange(other.message_, nullptr);
    }
    return *this;
  }
  Received(const Received&) = delete;
  Received& operator=(const Received&) = delete;

  explicit operator bool() const noexcept { return message_ != nullptr; }
  const Payload& operator*() const noexcept { return *message_; }
  const Payload* operator->() const noexcept { return message_; }
  [[nodiscard]] const Payload* get() const noexcept { return message_; }
  void reset() noexcept {
    if (message_ != nullptr) {
      from_->release(std::exchange(message_, nullptr));
    }
  }

 private:
  detail::RawSubscriber* from_ = nullptr;
  const Payload* message_ = nullptr;
};

/// Reads a topic. Belongs to one thread. Allocates nothing after construction. A subscriber in another
/// process than the publisher is connected within about 100 ms.
template <class Payload>
class Subscriber {
 public:
  explicit Subscriber(const Topic<Payload>& topic)
      : raw_(topic.name, topic.depth, topic.history, sizeof(Payload)) {}

  /// The oldest waiting message; empty when there is none.
  [[nodiscard]] Received<Payload> take() noexcept { return Received<Payload>(&raw_, raw_.take()); }

  /// The newest waiting message; older ones are given back unread (and do not count as dropped).
  [[nodiscard]] Received<Payload> take_latest() noexcept {
    Received<Payload> latest = take();
    while (latest) {
      Received<Payload> next = take();
      if (!next) {
        break;
      }
      latest = std::move(next);
    }
    return latest;
  }

  [[nodiscard]] bool has_data() const noexcept { return raw_.has_data(); }
  /// Messages that this reader lost because its queue was full, seen by the gaps in their numbers.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return raw_.dropped(); }
  /// Messages that were refused because their size is not this program's: the programs are of different
  /// builds.
  [[nodiscard]] std::uint64_t rejected() const noexcept { return raw_.rejected(); }
  [[nodiscard]] detail::RawSubscriber& raw() noexcept { return raw_; }

 private:
  detail::RawSubscriber raw_;
};

/// Sleeps until any of its subscribers has a message. wait() belongs to one thread; stop() and wake() may
/// come from any. Allocates nothing after construction.
class Waiter {
 public:
  static constexpr std::size_t kMaxSubscribers = 15;

  /// Usage: Waiter waiter({&imu.raw(), &wheel.raw()}). The subscribers must outlive the waiter.
  /// @throws ServiceError more than kMaxSubscribers, or the library refuses
  explicit Waiter(std::initializer_list<detail::RawSubscriber*> subscribers);
  ~Waiter();
  Waiter(const Waiter&) = delete;
  Waiter& operator=(const Waiter&) = delete;

  enum class Event : std::uint8_t { kData, kTimeout, kStopped };

  /// Returns at once while a message waits.
  [[nodiscard]] Event wait() noexcept;
  [[nodiscard]] Event wait_for(std::chrono::nanoseconds timeout) noexcept;

  /// Wakes the waiting thread; from now on every wait returns kStopped.
  void stop() noexcept;
  /// Wakes the waiting thread once, with kData though there may be none. Any thread.
  void wake() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isobar::ipc

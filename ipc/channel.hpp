// SPDX-License-Identifier: BSD-3-Clause
// Writer and reader of a topic in shared memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>

#include "ipc/topics.hpp"

namespace isobar::ipc {

class Waiter;

namespace detail {

/// Publisher of untyped chunks. Belongs to one thread.
class RawPublisher {
 public:
  /// @param bytes,alignment of the payload
  RawPublisher(const char* topic, std::uint32_t history, std::size_t bytes, std::size_t alignment);
  ~RawPublisher();
  RawPublisher(const RawPublisher&) = delete;
  RawPublisher& operator=(const RawPublisher&) = delete;

  void* loan() noexcept;  ///< nullptr: the pool has no free chunk
  void publish(void* chunk) noexcept;
  void discard(void* chunk) noexcept;
  [[nodiscard]] bool has_subscribers() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Subscriber of untyped chunks. Belongs to one thread.
class RawSubscriber {
 public:
  /// @param bytes expected size of the payload; messages of another size are refused, see rejected()
  RawSubscriber(const char* topic, std::uint32_t depth, std::uint32_t history, std::size_t bytes);
  ~RawSubscriber();
  RawSubscriber(const RawSubscriber&) = delete;
  RawSubscriber& operator=(const RawSubscriber&) = delete;

  const void* take() noexcept;  ///< the oldest waiting chunk; nullptr: none
  void release(const void* chunk) noexcept;
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

  /// A default-constructed message in shared memory, to be filled and then published or discarded. Up to 8
  /// may be on loan at a time. nullptr: the pool has no free chunk.
  [[nodiscard]] Payload* loan() noexcept {
    void* chunk = raw_.loan();
    return chunk == nullptr ? nullptr : new (chunk) Payload;
  }
  void publish(Payload* message) noexcept { raw_.publish(message); }
  void discard(Payload* message) noexcept { raw_.discard(message); }

  /// Publishes a copy. For small messages.
  /// @return false when the pool has no free chunk
  bool send(const Payload& message) noexcept {
    void* chunk = raw_.loan();
    if (chunk == nullptr) {
      return false;
    }
    raw_.publish(new (chunk) Payload(message));
    return true;
  }

  [[nodiscard]] bool has_subscribers() const noexcept { return raw_.has_subscribers(); }

 private:
  detail::RawPublisher raw_;
};

/// A received message; the destructor returns its chunk to the pool. Must not outlive its Subscriber. Same
/// thread as the Subscriber.
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

/// Reads a topic. Belongs to one thread. Allocates nothing after construction. Publisher and subscriber in
/// different processes are connected within about 100 ms.
template <class Payload>
class Subscriber {
 public:
  explicit Subscriber(const Topic<Payload>& topic)
      : raw_(topic.name, topic.depth, topic.history, sizeof(Payload)) {}

  /// The oldest waiting message; empty when none is waiting.
  [[nodiscard]] Received<Payload> take() noexcept { return Received<Payload>(&raw_, raw_.take()); }

  /// The newest waiting message; older ones are discarded and do not count as dropped.
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

  /// Messages lost to a full queue, from gaps in the publisher's sequence numbers.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return raw_.dropped(); }
  /// Messages refused for the size of their payload: publisher and subscriber come from different builds.
  [[nodiscard]] std::uint64_t rejected() const noexcept { return raw_.rejected(); }
  [[nodiscard]] detail::RawSubscriber& raw() noexcept { return raw_; }

 private:
  detail::RawSubscriber raw_;
};

}  // namespace isobar::ipc

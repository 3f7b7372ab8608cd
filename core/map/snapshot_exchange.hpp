// SPDX-License-Identifier: BSD-3-Clause
// Hands immutable snapshots from one writer to a few readers: no lock, nothing freed by a reader.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace isobar {

/// Hazard pointers for one value: the writer publishes, each reader pins what it reads, the writer frees what
/// nobody pins. publish() and the destructor belong to the writer's thread. Each reader thread uses its own
/// slot. (GCC 12's std::atomic<std::shared_ptr> takes a lock.) After M. M. Michael, "Hazard Pointers", 2004.
template <typename T, std::size_t kReaders = 2>
class SnapshotExchange {
 public:
  /// Holds one snapshot alive while it lives. Get it again for every scan.
  class Pin {
   public:
    Pin(const Pin&) = delete;
    Pin& operator=(const Pin&) = delete;
    ~Pin() { hazard_.store(nullptr, std::memory_order_release); }
    [[nodiscard]] const T& operator*() const { return *value_; }
    [[nodiscard]] const T* operator->() const { return value_; }

   private:
    friend class SnapshotExchange;
    Pin(const T* value, std::atomic<const T*>& hazard) : value_(value), hazard_(hazard) {}
    const T* value_;
    std::atomic<const T*>& hazard_;
  };

  explicit SnapshotExchange(std::shared_ptr<const T> first)
      : owner_(std::move(first)), current_(owner_.get()) {}

  /// Writer only: makes `next` (not null) the current snapshot and frees older ones that nobody pins.
  void publish(std::shared_ptr<const T> next) {
    if (next == owner_) {
      return;
    }
    current_.store(next.get(), std::memory_order_seq_cst);
    retired_.push_back(std::move(owner_));
    owner_ = std::move(next);
    std::erase_if(retired_, [this](const auto& old) { return !pinned(old.get()); });
  }

  /// Reader only, one thread and one pin at a time a slot: the newest snapshot. Repeats only when a publish()
  /// falls between its two loads.
  [[nodiscard]] Pin pin(std::size_t reader = 0) {
    std::atomic<const T*>& hazard = hazards_.at(reader).pointer;
    const T* value = current_.load(std::memory_order_seq_cst);
    for (;;) {
      hazard.store(value, std::memory_order_seq_cst);
      const T* again = current_.load(std::memory_order_seq_cst);
      if (again == value) {
        return Pin(value, hazard);
      }
      value = again;
    }
  }

  /// Writer only: snapshots that wait for a reader to let go.
  [[nodiscard]] std::size_t retired_count() const { return retired_.size(); }

 private:
  // One cache line each, so that readers do not disturb each other or the writer.
  struct alignas(64) Hazard {
    std::atomic<const T*> pointer{nullptr};
  };

  [[nodiscard]] bool pinned(const T* value) const {
    for (const Hazard& hazard : hazards_) {
      if (hazard.pointer.load(std::memory_order_seq_cst) == value) {
        return true;
      }
    }
    return false;
  }

  std::shared_ptr<const T> owner_;
  std::vector<std::shared_ptr<const T>> retired_;
  alignas(64) std::atomic<const T*> current_;
  std::array<Hazard, kReaders> hazards_;
};

}  // namespace isobar

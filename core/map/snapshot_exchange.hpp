// SPDX-License-Identifier: BSD-3-Clause
// Lock-free hand-over of immutable snapshots from one writer to a few readers; only the writer frees memory.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace isobar {

/// Hazard pointers for one value: the writer publishes, each reader pins the snapshot that it reads, the
/// writer frees snapshots that nobody pins. Constructor, publish() and destructor are called by the writer's
/// thread; each reader thread has its own slot. GCC 12's std::atomic<std::shared_ptr> would take a lock.
/// Source: M. M. Michael, "Hazard Pointers", 2004.
template <typename T, std::size_t kReaders = 2>
class SnapshotExchange {
 public:
  /// Keeps one snapshot alive. Short-lived: pin anew for every scan.
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

  /// `first`: not null.
  explicit SnapshotExchange(std::shared_ptr<const T> first)
      : owner_(std::move(first)), current_(owner_.get()) {}

  /// Writer only. Makes `next` (not null) the current snapshot and frees older ones that nobody pins.
  void publish(std::shared_ptr<const T> next) {
    if (next == owner_) {
      return;
    }
    current_.store(next.get(), std::memory_order_seq_cst);
    retired_.push_back(std::move(owner_));
    owner_ = std::move(next);
    std::erase_if(retired_, [this](const auto& old) { return !pinned(old.get()); });
  }

  /// Reader only. Pins the newest snapshot. `reader`: slot, 0 … kReaders - 1, with one thread and one pin at
  /// a time. Retries only if a publish() falls between its two loads.
  /// @throws std::out_of_range when `reader` is no slot
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

 private:
  // One cache line each: no false sharing between readers and writer.
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
  std::vector<std::shared_ptr<const T>> retired_;  // replaced, but still pinned
  alignas(64) std::atomic<const T*> current_;
  std::array<Hazard, kReaders> hazards_;
};

}  // namespace isobar

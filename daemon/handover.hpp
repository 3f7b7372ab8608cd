// SPDX-License-Identifier: BSD-3-Clause
// Hand-over of prepared objects to a thread that must neither allocate, free nor wait.
#pragma once

#include <atomic>
#include <memory>

namespace isobar {

/// One place for the newest object from the main thread to a worker, and one for the object that the worker no
/// longer needs, which the main thread frees. Lock-free. Two threads: main, or another one in its place, and worker.
template <class T>
class Handover {
 public:
  Handover() = default;
  ~Handover() {
    delete offered_.load();
    delete returned_.load();
  }
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  /// Main thread. Offers an object; replaces one that the worker has not taken yet.
  void offer(std::unique_ptr<T> next) {
    collect();
    delete offered_.exchange(next.release(), std::memory_order_acq_rel);
  }
  /// Main thread. Frees what the worker has returned. Call at least once between two offers' uses: the worker
  /// takes the next object only then.
  void collect() { delete returned_.exchange(nullptr, std::memory_order_acq_rel); }

  /// Worker. Calls `use(T&)` with the offered object, if there is one, and returns the object.
  template <class Use>
  void take(const Use& use) noexcept {
    if (offered_.load(std::memory_order_relaxed) == nullptr) return;
    if (returned_.load(std::memory_order_acquire) != nullptr) return;  // not collected yet
    T* const taken = offered_.exchange(nullptr, std::memory_order_acq_rel);
    if (taken == nullptr) return;
    use(*taken);
    returned_.store(taken, std::memory_order_release);
  }

 private:
  std::atomic<T*> offered_{nullptr};
  std::atomic<T*> returned_{nullptr};
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace isobar::web {

/// Threads for the connections of a server, and a short queue. While it is full, the server accepts no connection: those
/// that come wait in the kernel, and nothing grows.
class BoundedTasks final : public httplib::TaskQueue {
 public:
  explicit BoundedTasks(std::size_t threads) : most_waiting_(threads) {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
  }

  void enqueue(std::function<void()> task) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ending_ || waiting_.size() < most_waiting_; });
    waiting_.push_back(std::move(task));
    changed_.notify_all();
  }

  /// Finishes what has begun. The server calls it at its end.
  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void run() {
    for (;;) {
      std::function<void()> task;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        task = std::move(waiting_.front());
        waiting_.pop_front();
      }
      changed_.notify_all();
      task();
    }
  }

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false;
  std::deque<std::function<void()>> waiting_;
  std::vector<std::thread> threads_;
};

}  // namespace isobar::web

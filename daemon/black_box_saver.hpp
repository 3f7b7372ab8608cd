// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/black_box_ring.hpp"
#include "daemon/worker.hpp"

namespace isobar::black_box {

struct SaverSettings {
  std::filesystem::path folder;  ///< for saved recordings; empty: none is known, and every save fails
  int keep = 10;
  double min_free_mb = 500.0;
};

/// One ring to be saved: that of this run, or a left-over.
struct SaveJob {
  std::vector<OpenSegment> segments;  ///< of this run's ring
  std::filesystem::path left_over;    ///< folder of an earlier run's ring; removed once it is saved
  std::string reason;
  std::time_t utc_s = 0;
  std::uint64_t order = 0;  ///< BlackBoxOrder::number; 0: not ordered
};

struct SaveResult {
  std::uint64_t order = 0;
  bool failed = false;
  std::string text;  ///< the folder, or why there is none
};

/// Writes one ring as a recording folder: first under a hidden name, then renamed in one step.
/// @param cancelled checked all along; true ends the save
/// @return the folder
/// @throws Error when the disk refuses or has too little space, the ring holds nothing, or it was cancelled
std::filesystem::path save_ring(const SaveJob& job, const SaverSettings& settings,
                                const std::atomic<bool>& cancelled);

/// Saves rings one after the other, in a thread of low priority.
class Saver {
 public:
  explicit Saver(SaverSettings settings);

  /// Any thread.
  void submit(SaveJob job);
  [[nodiscard]] std::vector<SaveResult> take_results();

  [[nodiscard]] Worker& worker() noexcept { return worker_; }

 private:
  /// Queue of jobs; the wait of the thread.
  class Jobs {
   public:
    void add(SaveJob job);
    /// Waits for a job; false once stopped.
    bool take(SaveJob& job);
    void stop() noexcept;
    [[nodiscard]] const std::atomic<bool>& stopped() const { return stopped_; }

   private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<SaveJob> jobs_;
    std::atomic<bool> stopped_{false};
  };

  void loop() noexcept;
  SaveResult save(const SaveJob& job) noexcept;

  SaverSettings settings_;
  Jobs jobs_;
  std::mutex results_mutex_;
  std::vector<SaveResult> results_;
  Worker worker_;
};

}  // namespace isobar::black_box

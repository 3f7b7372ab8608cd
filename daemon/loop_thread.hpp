// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "daemon/loop_stage.hpp"
#include "daemon/map_thread.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Finds loops in the registered scans of a live run, beside the pipeline and without its priority: a scan that it misses
/// is one key scan less.
class LoopThread {
 public:
  /// `map`: gets the maps that were laid anew. Outlives this thread.
  LoopThread(const StageSettings& settings, std::unique_ptr<LoopFiles> files, MapThread& map,
             ThreadSettings scheduling);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  /// Once the worker has stopped.
  [[nodiscard]] LoopStage& stage() noexcept { return stage_; }

 private:
  void loop() noexcept;
  void drain() noexcept;

  void log_problem();

  LoopStage stage_;
  MapThread& map_;
  std::string logged_;
  ipc::Subscriber<RegisteredScan> scans_;
  ipc::Subscriber<Prior> priors_;
  ipc::Waiter waiter_;
  Worker worker_;
};

}  // namespace isobar

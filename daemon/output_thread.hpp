// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

/// Writes every pose to the run folder. Not real-time. A full
/// disk ends the writing; poses are still published.
class OutputThread {
 public:
  OutputThread(files::RunOutput& output, ThreadSettings settings);

  /// Once stopped, every waiting pose is written.
  [[nodiscard]] Worker& worker() noexcept { return worker_; }

 private:
  void loop() noexcept;
  void drain() noexcept;

  files::RunOutput* output_;  ///< null after a failed write
  ipc::Subscriber<PoseEstimate> poses_;
  ipc::Subscriber<Prior> priors_;
  ipc::Waiter waiter_;
  Prior newest_prior_;
  Worker worker_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <thread>

#include "daemon/realtime.hpp"
#include "daemon/worker_watch.hpp"
#include "ipc/shared_memory.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

/// Writes every pose to the folder of the run. Not real-time; a full disk ends the writing, never the poses.
class OutputThread {
 public:
  OutputThread(files::RunOutput& output, ThreadSettings settings);
  ~OutputThread();
  OutputThread(const OutputThread&) = delete;
  OutputThread& operator=(const OutputThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended and every waiting pose is written
  void knock() noexcept { waiter_.wake(); }  ///< see WorkerWatch; any thread
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void loop() noexcept;
  void drain() noexcept;

  ThreadSettings settings_;
  files::RunOutput* output_;
  ipc::Subscriber<PoseEstimate> poses_;
  ipc::Subscriber<Prior> priors_;
  ipc::Waiter waiter_;
  Prior newest_prior_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar

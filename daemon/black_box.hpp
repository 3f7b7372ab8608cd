// SPDX-License-Identifier: BSD-3-Clause
// The black box: the last minute of all inputs in memory, saved as a recording on an order, on a fault and
// after a crash.
//
//   inputs ─▶ [blackbox] ─▶ ring of segment files in memory ─▶ [blackbox-save] ─▶ recording folder on the disk
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "daemon/black_box_ring.hpp"
#include "daemon/black_box_saver.hpp"
#include "daemon/black_box_trigger.hpp"
#include "daemon/input_tap.hpp"
#include "daemon/stoppable_timer.hpp"
#include "daemon/worker.hpp"
#include "daemon/worker_group.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::black_box {

/// Blocks SIGUSR1, the signal that saves the black box, in this thread and in all threads started later. Call
/// it before the first thread, also where the black box is off: by default the signal ends a program.
void block_save_signal();

/// The black box. Its threads have ordinary priority; the real-time threads only publish.
class BlackBox {
 public:
  /// Null when black_box.span_s is 0, or when the system refuses, which the log says: poses need no black box.
  [[nodiscard]] static std::unique_ptr<BlackBox> make(const Config& config);
  /// Removes the ring: the end is a clean one.
  ~BlackBox();
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;

  /// Adds the threads. They are not watched: a slow disk is no reason to restart the estimator.
  void add_to(WorkerGroup& workers);
  /// Adds the entry "black_box". Any thread.
  void fill_health(ipc::HealthReport& report) const;

 private:
  explicit BlackBox(const Config& config);

  void loop() noexcept;
  void round();
  void take_description();
  void take_orders(std::int64_t now_ns);
  void take_results();
  void save(const std::string& reason, std::uint64_t order);
  void publish_state(std::int64_t now_ns);
  /// @param can_save false: there is no folder for them, they are removed
  void take_left_overs(bool can_save);

  InputTap tap_;
  ipc::Subscriber<ipc::RunDescription> descriptions_;
  ipc::Subscriber<ipc::HealthReport> healths_;
  ipc::Subscriber<ipc::BlackBoxOrder> orders_;
  ipc::Publisher<ipc::BlackBoxState> publisher_;
  FileDescriptor signal_;
  FaultTrigger trigger_;
  Saver saver_;
  std::filesystem::path memory_;  ///< folder of the rings
  std::unique_ptr<Ring> ring_;
  recording::InputLog log_;
  std::string head_text_;      ///< manifest and settings in the segments' heads
  std::uint64_t refused_ = 0;  ///< records that the file system of the ring refused
  std::int64_t published_ns_ = 0;
  ipc::BlackBoxState state_;
  mutable std::mutex shared_mutex_;
  ipc::BlackBoxState shared_state_;  ///< for fill_health()
  StoppableTimer timer_;
  Worker worker_;
};

}  // namespace isobar::black_box

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/checkpoint_draft.hpp"
#include "daemon/output_status.hpp"
#include "daemon/run_files.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Writes poses and checkpoints to the disk, and waits for the disk on behalf of the map thread. Not
/// real-time. While the disk refuses, poses are published as ever and some minutes of them are kept.
class OutputThread {
 public:
  /// @param datum the present height datum; any thread may call it
  OutputThread(RunFiles& files, std::function<HeightDatum()> datum, ThreadSettings settings);

  /// Once stopped, every waiting pose is written.
  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] OutputStatus status() const noexcept { return status_.get(); }

 private:
  void loop() noexcept;
  void drain() noexcept;
  void add_pose(const PoseEstimate& pose) noexcept;
  void write() noexcept;
  void write_checkpoint();
  void write_map_checkpoint(const files::Checkpoint& checkpoint);
  void report(const std::string& failure) noexcept;

  RunFiles& files_;
  std::function<HeightDatum()> datum_;
  std::filesystem::path checkpoint_file_;
  ipc::Subscriber<PoseEstimate> poses_;
  ipc::Subscriber<Prior> priors_;
  ipc::Waiter waiter_;
  Prior newest_prior_;
  CheckpointDraft checkpoint_;
  std::int64_t written_ns_ = 0;      ///< robot clock
  std::int64_t map_written_ns_ = 0;  ///< of the checkpoint beside the tiles
  std::uint32_t map_session_ = 0;    ///< the same
  bool stopping_ = false;
  std::string add_failure_;  ///< since the last write()
  OutputStatus draft_status_;
  SeqLock<OutputStatus> status_;
  Worker worker_;
};

}  // namespace isobar

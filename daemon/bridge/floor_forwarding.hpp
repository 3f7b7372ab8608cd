// SPDX-License-Identifier: BSD-3-Clause
// Floors from shared memory to DDS.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/seq_lock.hpp"
#include "ipc/dds/floor_outputs.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Counts of a FloorForwarding, and what was last said of the floor, for the diagnostics.
struct FloorState {
  std::uint64_t lost = 0;      ///< messages lost to a full queue
  std::uint64_t refused = 0;   ///< implausible
  std::uint64_t rejected = 0;  ///< of another build
  std::uint64_t unsent = 0;
  bool heard = false;
  ipc::CurrentFloor floor;
};

/// Forwards the grid of the floor and the floor itself, in a thread of its own: a grid of 64 MB delays neither odometry
/// nor scans. The grid is received whether or not somebody reads it, because readers may come later.
class FloorForwarding {
 public:
  /// @param stamp_shift_ns time of day minus robot clock; outlives the object, as `outputs`
  /// @throws ServiceError when shared memory cannot be used
  FloorForwarding(dds::FloorOutputs& outputs, const std::atomic<std::int64_t>& stamp_shift_ns);
  ~FloorForwarding();
  FloorForwarding(const FloorForwarding&) = delete;
  FloorForwarding& operator=(const FloorForwarding&) = delete;

  /// Keeps the thread from the outputs as long as the result exists.
  [[nodiscard]] std::unique_lock<std::mutex> pause() { return std::unique_lock(mutex_); }
  /// Writers made so far: a larger number than before means that the node must be announced again. Any thread.
  [[nodiscard]] std::size_t writer_count() const noexcept { return writers_.load(std::memory_order_relaxed); }
  /// Any thread.
  [[nodiscard]] FloorState state() const noexcept { return state_.get(); }

 private:
  void loop() noexcept;
  void forward();

  dds::FloorOutputs& outputs_;
  const std::atomic<std::int64_t>& stamp_shift_ns_;
  ipc::Subscriber<ipc::FloorGrid> grids_{ipc::topics::kFloorGrid};
  ipc::Subscriber<ipc::CurrentFloor> floors_{ipc::topics::kFloor};
  ipc::Waiter waiter_;
  std::mutex mutex_;   ///< held by the thread while it uses the outputs
  std::string fault_;  ///< last one in the log
  std::atomic<std::size_t> writers_{0};
  FloorState draft_;
  SeqLock<FloorState> state_;
  std::thread thread_;
};

}  // namespace isobar::bridge

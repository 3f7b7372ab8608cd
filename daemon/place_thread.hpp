// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/map_thread.hpp"
#include "daemon/place_stage.hpp"
#include "daemon/registration_thread.hpp"
#include "daemon/run_files.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Searches the place of a live run in its whole map, beside the pipeline and without its priority. The tiles around a place
/// that it finds are read before the registration tries it.
class PlaceThread {
 public:
  /// @param files the folders of the maps, and where the run begins
  PlaceThread(const StageSettings& settings, const RunFiles& files, MapThread& map,
              RegistrationThread& registration, ThreadSettings scheduling);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] PlaceStatus status() const noexcept { return status_.get(); }

 private:
  void loop() noexcept;
  void drain() noexcept;
  void follow(const PlaceOrder& order, const PoseEstimate& pose);

  PlaceStage stage_;
  MapThread& map_;
  RegistrationThread& registration_;
  std::optional<PlaceOrder> found_;  ///< waits for the tiles around it
  std::uint64_t looked_before_ = 0;
  ipc::Subscriber<RegisteredScan> scans_;
  ipc::Subscriber<Prior> priors_;
  ipc::Waiter waiter_;
  SeqLock<PlaceStatus> status_;
  Worker worker_;
};

}  // namespace isobar

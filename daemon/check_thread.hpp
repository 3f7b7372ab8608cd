// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "core/contradictions/input_check.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Runs the detectors of contradictions on the samples of a live run, beside the pipeline and without its priority: a
/// late finding is still one. Gravity tells within three seconds, a unit of the gyro as soon as the robot has turned by
/// 20 deg. A finding stays until the restart: its remedy is in the configuration or in a sensor, and both begin anew.
class CheckThread {
 public:
  /// @param has_imu false: samples that come nevertheless are not checked, as they are not used
  CheckThread(const InputCheckConfig& config, bool has_imu, ThreadSettings settings);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] Findings findings() const noexcept { return status_.get(); }

 private:
  void loop() noexcept;
  void drain() noexcept;
  void judge(std::int64_t now_ns) noexcept;
  void renew() noexcept;

  InputCheckConfig config_;
  bool has_imu_;
  std::unique_ptr<InputCheck> check_;  ///< null: twenty minutes were enough
  ipc::Subscriber<Scan> scans_;
  ipc::Subscriber<ImuSample> imu_;
  ipc::Subscriber<PressureSample> barometer_;
  ipc::Subscriber<PressureSample> base_barometer_;
  ipc::Subscriber<WheelSample> wheel_;
  ipc::Waiter waiter_;
  std::int64_t judged_ns_ = 0;         // robot clock
  std::int64_t clocks_judged_ns_ = 0;  // robot clock
  Findings kept_;
  SeqLock<Findings> status_;
  Worker worker_;
};

}  // namespace isobar

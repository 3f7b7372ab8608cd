// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/sensor_compensation.hpp"
#include "core/time/cadence.hpp"
#include "daemon/arrival_meter.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the station thread.
struct StationStatus {
  std::uint64_t samples = 0;
  std::uint64_t dropped_samples = 0;  ///< lost to a full queue of this thread
  std::uint64_t samples_without_memory = 0;
  Cadence cadence;  ///< of the samples, robot clock
  ArrivalMeter arrivals;
  std::uint64_t outside_calibration = 0;
  std::uint64_t without_temperature = 0;  ///< samples without the temperature that the calibration needs
  std::int64_t changed_ns = 0;  ///< stamp of the newest sample whose pressure differs from its predecessor's
  PressureSample newest;        ///< as published
};

/// Calibrates a base station's samples, adds their measured noise and publishes
/// them for isobar-dds to send to the robots. A sample with a variance of its own
/// keeps it; other samples get the estimate once its own error is below a third.
class StationThread {
 public:
  StationThread(const AltimeterConfig& config, const CompensationConfig& compensation,
                ThreadSettings settings);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] StationStatus status() const noexcept { return status_.get(); }

 private:
  void loop() noexcept;
  void drain() noexcept;
  void take(const PressureSample& raw) noexcept;

  SensorCompensation compensation_;
  NoiseEstimator noise_;
  std::uint64_t noise_samples_ = 0;  // that the noise estimate rests on
  ipc::Subscriber<PressureSample> barometer_;
  ipc::Publisher<PressureSample> publisher_;
  ipc::Waiter waiter_;
  StationStatus draft_status_;
  SeqLock<StationStatus> status_;
  Worker worker_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <thread>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/noise_estimator.hpp"
#include "core/altitude/sensor_compensation.hpp"
#include "core/time/cadence.hpp"
#include "daemon/realtime.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker_watch.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the station thread says of its barometer.
struct StationStatus {
  std::uint64_t samples = 0;
  std::uint64_t dropped_samples = 0;  ///< lost because this thread came too late
  std::uint64_t samples_without_memory = 0;
  Cadence cadence;  ///< of the samples, robot clock
  std::uint64_t outside_calibration = 0;
  std::uint64_t without_temperature = 0;  ///< that the calibration needs
  std::int64_t changed_ns = 0;  ///< stamp of the newest sample whose pressure was not that of the one before
  PressureSample newest;        ///< as it goes out
};

/// A base station's barometer in, the same samples calibrated and with their noise out, for isobar-dds to
/// tell to the robots. A sample whose sender does not know its variance gets the measured one, once enough
/// samples have come.
class StationThread {
 public:
  StationThread(const AltimeterConfig& config, const CompensationConfig& compensation,
                ThreadSettings settings);
  ~StationThread();
  StationThread(const StationThread&) = delete;
  StationThread& operator=(const StationThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] StationStatus status() const noexcept { return status_.get(); }
  void knock() noexcept { waiter_.wake(); }  ///< see WorkerWatch; any thread
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void loop() noexcept;
  void drain() noexcept;
  void take(const PressureSample& raw) noexcept;

  ThreadSettings settings_;
  SensorCompensation compensation_;
  NoiseEstimator noise_;
  std::uint64_t measured_ = 0;  // samples that the estimator has seen
  ipc::Subscriber<PressureSample> barometer_;
  ipc::Publisher<PressureSample> publisher_;
  ipc::Waiter waiter_;
  StationStatus own_;
  SeqLock<StationStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <thread>

#include "core/prior/prior_estimator.hpp"
#include "core/time/cadence.hpp"
#include "daemon/deadline.hpp"
#include "daemon/realtime.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker_watch.hpp"
#include "drivers/datagram/datagram.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// What the prior thread says of itself.
struct PriorStatus {
  PriorCounters counters;
  std::array<std::uint64_t, datagram::kKinds> samples{};        ///< by Kind, however they came
  std::array<std::int64_t, datagram::kKinds> last_sample_ns{};  ///< robot clock, by Kind, 0: none yet
  std::array<Cadence, 2> base_stations;                         ///< by PressureSample::station, robot clock
  std::uint64_t dropped_samples = 0;                            ///< lost because this thread came too late
  std::int64_t stamp_ns = 0;                                    ///< of the newest prior, 0: none yet
  double height_m = 0.0;
  double height_variance_m2 = 0.0;
  HeightSource height_source = HeightSource::kNone;
  BarometerHealth barometers;
  bool attitude_valid = false;
  DeadlineStatus punctuality;  ///< from an IMU sample to its prior handed on
};

/// Samples in, one prior an IMU sample out.
class PriorThread {
 public:
  PriorThread(const PriorConfig& config, ThreadSettings settings);
  ~PriorThread();
  PriorThread(const PriorThread&) = delete;
  PriorThread& operator=(const PriorThread&) = delete;

  void start();
  void stop() noexcept;  ///< returns when the thread has ended

  [[nodiscard]] PriorStatus status() const noexcept { return status_.get(); }
  void knock() noexcept { waiter_.wake(); }  ///< see WorkerWatch; any thread
  [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }

 private:
  void loop() noexcept;
  void drain() noexcept;
  template <class Sample>
  ipc::Received<Sample> take(ipc::Subscriber<Sample>& from, datagram::Kind kind) noexcept;
  void describe(const Prior& prior) noexcept;

  ThreadSettings settings_;
  PriorEstimator estimator_;
  ipc::Subscriber<ImuSample> imu_;
  ipc::Subscriber<PressureSample> barometer_;
  ipc::Subscriber<PressureSample> base_barometer_;
  ipc::Subscriber<WheelSample> wheel_;
  ipc::Publisher<Prior> publisher_;
  ipc::Waiter waiter_;
  Deadline deadline_;
  PriorStatus own_;
  SeqLock<PriorStatus> status_;
  Heartbeat heartbeat_;
  std::thread thread_;
};

}  // namespace isobar

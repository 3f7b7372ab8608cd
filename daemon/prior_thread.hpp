// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>

#include "core/contradictions/finding.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/prior/prior_pace.hpp"
#include "core/time/cadence.hpp"
#include "daemon/arrival_meter.hpp"
#include "daemon/deadline.hpp"
#include "daemon/handover.hpp"
#include "daemon/path_choice.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "drivers/datagram/datagram.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the prior thread.
struct PriorStatus {
  PriorCounters counters;
  std::array<std::uint64_t, datagram::kKinds> samples{};        ///< by Kind, from UDP and DDS
  std::array<std::int64_t, datagram::kKinds> last_sample_ns{};  ///< robot clock, by Kind; 0: none yet
  std::array<Cadence, 2> base_stations;                         ///< by PressureSample::station, robot clock
  std::array<PathStatus, 2> base_paths;                         ///< by PressureSample::station
  PathStatus imu_path;
  PathStatus wheel_path;
  std::int64_t imu_resumed_ns = 0;                        ///< end of its last silence, robot clock; 0: never
  std::array<ArrivalMeter, datagram::kKinds> arrivals;    ///< by Kind; of base stations the first one
  std::array<std::uint64_t, datagram::kKinds> dropped{};  ///< lost to a full queue, by Kind
  std::uint64_t dropped_samples = 0;                      ///< their sum
  std::int64_t stamp_ns = 0;                              ///< of the newest prior; 0: none yet
  double height_m = 0.0;
  double height_variance_m2 = 0.0;
  HeightSource height_source = HeightSource::kNone;
  BarometerHealth barometers;
  bool attitude_valid = false;
  HeightDatum datum;           ///< for the next run
  DeadlineStatus punctuality;  ///< from an IMU sample to the publication of its prior
};

/// Fuses samples into one prior per IMU sample; without an IMU into one at each step of PriorPace.
class PriorThread {
 public:
  PriorThread(const PriorConfig& config, ThreadSettings settings);

  /// Continues the height of an earlier run. Before the start.
  void resume(const HeightDatum& datum) { estimator_.resume(datum); }

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  /// Changes the deadline and the settings that PriorEstimator::configure() takes, from the next round on. Main
  /// thread, as collect().
  void configure(const PriorConfig& config, double deadline_ms) {
    changes_.offer(std::make_unique<Change>(Change{config, deadline_ms, nullptr, {}}));
  }
  /// Goes on without the sensors that are not usable, with an estimate that has never heard them. Main thread.
  /// @param config PriorConfig::has_imu as usable.imu
  void leave_out(const PriorConfig& config, const UsableSensors& usable, double deadline_ms);
  void collect() { changes_.collect(); }

  [[nodiscard]] PriorStatus status() const noexcept { return status_.get(); }

 private:
  struct Change {
    PriorConfig config;
    double deadline_ms;
    std::unique_ptr<PriorEstimator> estimator;  ///< replaces the one in use; null: none does
    UsableSensors usable;                       ///< with it
  };
  void obey(Change& change) noexcept;
  void loop() noexcept;
  [[nodiscard]] std::chrono::nanoseconds poll() const noexcept;
  void drain() noexcept;
  void drain_imu() noexcept;
  void advance(std::int64_t now_ns) noexcept;
  void publish(const Prior& prior) noexcept;
  template <class Sample>
  ipc::Received<Sample> take(ipc::Subscriber<Sample>& from, datagram::Kind kind) noexcept;
  void describe(const Prior& prior) noexcept;
  template <class Sample>
  void note_arrival(const Sample& sample, datagram::Kind kind) noexcept;

  bool has_imu_;
  UsableSensors usable_;
  PriorEstimator estimator_;
  PriorPace pace_;  ///< without an IMU
  std::array<PathChoice, 2> base_paths_{
      PathChoice(PathChoice::kBaseTakeoverNs),
      PathChoice(PathChoice::kBaseTakeoverNs)};  ///< by PressureSample::station
  PathChoice imu_path_{PathChoice::kSensorTakeoverNs};
  PathChoice wheel_path_{PathChoice::kSensorTakeoverNs};
  ipc::Subscriber<ImuSample> imu_;
  ipc::Subscriber<PressureSample> barometer_;
  ipc::Subscriber<PressureSample> base_barometer_;
  ipc::Subscriber<WheelSample> wheel_;
  ipc::Publisher<Prior> publisher_;
  ipc::Waiter waiter_;
  Deadline deadline_;
  Handover<Change> changes_;
  PriorStatus draft_status_;
  SeqLock<PriorStatus> status_;
  Worker worker_;
};

}  // namespace isobar

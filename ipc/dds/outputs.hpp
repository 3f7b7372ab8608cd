// SPDX-License-Identifier: BSD-3-Clause
// DDS outputs: the published topics and their rates.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/estimates.hpp"
#include "core/registration/pose_propagator.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/messages.hpp"
#include "ipc/dds_config.hpp"
#include "ipc/topics.hpp"

namespace isobar::dds {

/// Thins a stream of samples to `rate_hz` on average; a slower stream passes unchanged.
class RateLimit {
 public:
  explicit RateLimit(double rate_hz) : period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {}

  /// True when a message with this stamp is due. A stamp more than two periods before the next due time
  /// restarts the schedule.
  bool due(std::int64_t stamp_ns) noexcept {
    // Tolerance of a tenth of the period, so that jitter of a source at exactly this rate drops no sample.
    // The schedule advances by whole periods, so the average rate stays exact.
    const std::int64_t early_ns = next_ns_ - stamp_ns;
    if (early_ns > period_ns_ / 10 && early_ns <= 2 * period_ns_) {
      return false;
    }
    const bool on_time = early_ns <= period_ns_ / 10 && early_ns > -period_ns_;
    next_ns_ = (on_time ? next_ns_ : stamp_ns) + period_ns_;
    return true;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_ = INT64_MIN / 2;
};

/// odom, pose, tf, tf_static, altitude. One thread.
class PoseOutputs {
 public:
  /// @throws ServiceError when a DDS entity cannot be created
  PoseOutputs(dds_entity_t participant, const DdsConfig& config, const SensorMounts& mounts);
  PoseOutputs(const PoseOutputs&) = delete;
  PoseOutputs& operator=(const PoseOutputs&) = delete;

  /// Time of day minus robot clock, added to the stamps of all later messages [ns]. The values of on_prior() and
  /// on_pose() stay on the robot clock, which never jumps.
  void set_stamp_shift_ns(std::int64_t shift_ns) noexcept { shift_ns_ = shift_ns; }
  /// Publishes altitude, odom and tf at their rates.
  void on_prior(const Prior& prior);
  /// Publishes the pose and passes it to the propagator of odom and tf.
  void on_pose(const PoseEstimate& pose);

  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  [[nodiscard]] std::uint64_t failures() const noexcept;

 private:
  void write_static_transforms(const SensorMounts& mounts);
  void write_transforms(const Odometry& odometry);

  DdsConfig config_;
  std::int64_t shift_ns_ = 0;
  PosePropagator propagator_;
  RateLimit odom_rate_;
  RateLimit altitude_rate_;
  Writer<OdometryMessage> odom_;
  Writer<PoseMessage> pose_;
  Writer<TfMessage> tf_;
  Writer<TfMessage> tf_static_;
  Writer<AltitudeMessage> altitude_;
};

/// Outputs of a base station: NAME/fluid_pressure and NAME/temperature, with equal stamps. One thread.
class StationOutputs {
 public:
  /// @param name name of the base station and of its frame
  /// @throws ServiceError when a DDS entity cannot be created
  StationOutputs(dds_entity_t participant, const std::string& name);
  StationOutputs(const StationOutputs&) = delete;
  StationOutputs& operator=(const StationOutputs&) = delete;

  /// A sample whose temperature is NaN gives a pressure message only.
  /// @param shift_ns see PoseOutputs::set_stamp_shift_ns()
  void on_pressure(const PressureSample& measured, std::int64_t shift_ns);

  [[nodiscard]] std::vector<dds_entity_t> writers() const { return {pressure_.get(), temperature_.get()}; }
  [[nodiscard]] std::uint64_t failures() const noexcept {
    return pressure_.failures() + temperature_.failures();
  }

 private:
  std::string frame_;
  Writer<PressureMessage> pressure_;
  Writer<TemperatureMessage> temperature_;
};

/// registered_scan and map. One thread; it may differ from the thread of PoseOutputs.
class CloudOutputs {
 public:
  /// @throws ServiceError when a DDS entity cannot be created
  CloudOutputs(dds_entity_t participant, const DdsConfig& config);
  CloudOutputs(const CloudOutputs&) = delete;
  CloudOutputs& operator=(const CloudOutputs&) = delete;

  /// Publishes the deskewed scan in base_link at the scan's end, which is its stamp. Skipped without readers.
  /// @param shift_ns see PoseOutputs::set_stamp_shift_ns()
  void on_scan(const RegisteredScan& scan, std::int64_t shift_ns);
  /// Publishes the local map, in the map frame.
  void on_map(const ipc::MapCloud& map, std::int64_t shift_ns);

  [[nodiscard]] std::vector<dds_entity_t> writers() const { return {scan_.get(), map_.get()}; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return scan_.failures() + map_.failures(); }

 private:
  DdsConfig config_;
  CloudBuilder builder_;
  Writer<CloudMessage> scan_;
  Writer<CloudMessage> map_;
};

}  // namespace isobar::dds

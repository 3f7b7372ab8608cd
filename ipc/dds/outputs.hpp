// SPDX-License-Identifier: BSD-3-Clause
// All that Isobar says over DDS, one function a topic.
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

/// Lets so many samples through that `rate_hz` come out on average, or all if there are fewer.
class RateLimit {
 public:
  explicit RateLimit(double rate_hz) : period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {}

  /// True when a message with this stamp is due. A stamp that goes back far starts over.
  bool due(std::int64_t stamp_ns) noexcept {
    // A source of just this rate jitters: it may be early by a tenth, which the next one makes good.
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
  /// @throws ServiceError DDS refuses
  PoseOutputs(dds_entity_t participant, const DdsConfig& config, const SensorMounts& mounts);
  PoseOutputs(const PoseOutputs&) = delete;
  PoseOutputs& operator=(const PoseOutputs&) = delete;

  /// Publishes altitude, odom and tf at their rates.
  void on_prior(const Prior& prior);
  void on_pose(const PoseEstimate& pose);

  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  [[nodiscard]] std::uint64_t failures() const noexcept;

 private:
  void write_static_transforms(const SensorMounts& mounts);
  void write_transforms(const Odometry& odometry);

  DdsConfig config_;
  PosePropagator propagator_;
  RateLimit odom_rate_;
  RateLimit altitude_rate_;
  Writer<OdometryMessage> odom_;
  Writer<PoseMessage> pose_;
  Writer<TfMessage> tf_;
  Writer<TfMessage> tf_static_;
  Writer<AltitudeMessage> altitude_;
};

/// What a base station tells: NAME/fluid_pressure and NAME/temperature, which have the same stamp. One
/// thread.
class StationOutputs {
 public:
  /// @param name of the station and of its frame
  /// @throws ServiceError DDS refuses
  StationOutputs(dds_entity_t participant, const std::string& name);
  StationOutputs(const StationOutputs&) = delete;
  StationOutputs& operator=(const StationOutputs&) = delete;

  /// A sample without temperature gives pressure only.
  void on_pressure(const PressureSample& sample);

  [[nodiscard]] std::vector<dds_entity_t> writers() const { return {pressure_.get(), temperature_.get()}; }
  [[nodiscard]] std::uint64_t failures() const noexcept {
    return pressure_.failures() + temperature_.failures();
  }

 private:
  std::string frame_;
  Writer<PressureMessage> pressure_;
  Writer<TemperatureMessage> temperature_;
};

/// registered_scan and map. One thread, which need not be that of PoseOutputs.
class CloudOutputs {
 public:
  /// @throws ServiceError DDS refuses
  CloudOutputs(dds_entity_t participant, const DdsConfig& config);
  CloudOutputs(const CloudOutputs&) = delete;
  CloudOutputs& operator=(const CloudOutputs&) = delete;

  /// The scan in the frame of base_link at its stamp, the end of the scan. Nothing is sent if nobody listens.
  void on_scan(const RegisteredScan& scan);
  /// The local map in the map frame.
  void on_map(const ipc::MapCloud& map);

  [[nodiscard]] std::vector<dds_entity_t> writers() const { return {scan_.get(), map_.get()}; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return scan_.failures() + map_.failures(); }

 private:
  DdsConfig config_;
  CloudBuilder builder_;
  Writer<CloudMessage> scan_;
  Writer<CloudMessage> map_;
};

}  // namespace isobar::dds
